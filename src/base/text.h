#pragma once
// Words that people mistype, and bytes that are no text.

#include <span>
#include <string>
#include <string_view>

#include "gloam/program.h"  // suggest_name

namespace gloam {

/// The candidate with the smallest edit distance to `word`, or "" when none is close (distance > a
/// third of its length + 1).
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

/// Lower case of ASCII letters; other characters stay.
std::string lower_case(std::string_view text);

/// True if `name` is `pattern` with any text in the place of each *.
bool fits_pattern(std::string_view pattern, std::string_view name);

/// Bytes of the character at the start of `text`; 0 if it is none (RFC 3629, table 3-7 of Unicode).
size_t utf8_length(std::string_view text);

/// With U+FFFD in the place of every byte that is no part of UTF-8 (RFC 3629).
std::string as_utf8(std::string_view text);

}  // namespace gloam
