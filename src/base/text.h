#pragma once
// Help with words that people mistype.

#include <span>
#include <string>
#include <string_view>

#include "gloam/program.h"  // suggest_name

namespace gloam {

/// The candidate with the smallest edit distance to `word`, or "" when none is close (distance > a
/// third of its length + 1).
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

/// True if `name` is `pattern` with any text in the place of each *.
bool fits_pattern(std::string_view pattern, std::string_view name);

}  // namespace gloam
