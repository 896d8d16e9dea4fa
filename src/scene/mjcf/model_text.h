#pragma once
// A model in TOML as the XML that MuJoCo reads, and the way back for what it says of it.

#include <string>
#include <string_view>
#include <vector>

#include "gloam/mjcf.h"

namespace gloam {

struct ModelText {
  mjcf::Document document;
  std::string xml;
  /// The line of the TOML that each line of `xml` comes from, from 1; [0] = 0.
  std::vector<int> lines;
};

/// Errors: those of Document::from_toml.
Result<ModelText> translate_model(std::string_view toml, const std::string& file);

}  // namespace gloam
