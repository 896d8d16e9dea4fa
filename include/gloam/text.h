#pragma once
// Display of untrusted text (names, keys, messages).

#include <string>
#include <string_view>

namespace gloam {

/// Returns `text` in a form that cannot control a terminal: control characters, line separators and
/// direction marks are escaped as \n, \x1b, \u009b, \u202e, and bytes that are not UTF-8 as \x9b.
/// `kept`: control characters that are not escaped.
std::string printable(std::string_view text, std::string_view kept = {});

}  // namespace gloam
