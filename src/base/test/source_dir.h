// The folder of the source, for tests that read examples, documents or assets.
#pragma once

#include <filesystem>

namespace gloam {

const std::filesystem::path& source_dir();

}  // namespace gloam
