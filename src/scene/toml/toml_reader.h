#pragma once
// Reads TOML into option structs through visit_fields(). Only keys that stand in the text are
// touched. The first error stops the reading.

#include <string>
#include <string_view>

#include "gloam/scene.h"

namespace gloam {

/// Reads the text of a whole scene file into `scene`. `file` names it in errors. Paths stay as
/// written. Errors: syntax, unknown key, wrong type, value out of range, missing key.
Status read_scene_toml(std::string_view text, const std::string& file, Scene* scene);

/// Nearest fraction when `x` is exactly the double of one with a denominator of at most 10000.
bool exact_rational(double x, Rational* out);

}  // namespace gloam
