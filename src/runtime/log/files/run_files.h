#pragma once
// Files that a World was made of.

#include <filesystem>
#include <vector>

#include "world/world.h"

namespace gloam {

/// Absolute paths of all existing files that a World was made of, each once: models with what they
/// include, meshes with their pictures, skies, grids, behaviour trees, and each package.xml above
/// them, by which package:// names are found.
std::vector<std::filesystem::path> run_files(const CompiledWorld& world);

}  // namespace gloam
