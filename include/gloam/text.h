#pragma once
// Texts of strangers (names, keys, messages) where people see them.

#include <string>
#include <string_view>

namespace gloam {

/// `text` as a terminal shows and does not obey it: control characters, separators of lines and
/// marks of direction become \n, \x1b, \u009b, \u202e, and bytes that are no UTF-8 \x9b. `kept`:
/// control characters that stay as they are.
std::string printable(std::string_view text, std::string_view kept = {});

}  // namespace gloam
