#pragma once
// Reads TOML into option structs through visit_fields(). Only keys that stand in the text are
// touched. The first error stops the reading.

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "gloam/scene.h"

namespace gloam {

/// Place of a toml::node, toml::key or toml::parse_error; `file` where it does not know its own.
template <class Parsed>
SourceLoc loc_of(const Parsed& parsed, const std::string& file) {
  const toml::source_region& source = parsed.source();
  return {source.path ? *source.path : file, static_cast<int>(source.begin.line),
          static_cast<int>(source.begin.column)};
}

/// Errors: syntax, with the place.
Result<toml::table> parse_toml(std::string_view text, const std::string& file);

/// Reads a whole scene file into `scene`. `file` names it in errors. Paths stay as written. Errors:
/// unknown key, wrong type, value out of range, missing key; of text, syntax.
Status read_scene_toml(const toml::table& root, const std::string& file, Scene* scene);
Status read_scene_toml(std::string_view text, const std::string& file, Scene* scene);

/// Nearest fraction when `x` is exactly the double of one with a denominator of at most 10000.
bool exact_rational(double x, Rational* out);

}  // namespace gloam
