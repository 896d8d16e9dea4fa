#pragma once
// Depth of a stranger's text, found by one pass over its characters before a library reads it:
// parsers, and whoever walks what they made, recurse, and a stack ends without a word. Whether the
// text is well-formed at all is the parser's business; text behind a syntax error is never
// reached by it.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam {

inline constexpr int kDeepestXml = 200;          ///< elements in each other
inline constexpr int kMostXmlAttributes = 1000;  ///< attributes of one element; MuJoCo's have < 60
inline constexpr int kDeepestToml = 256;         ///< parts of a key and its header, brackets
inline constexpr int kDeepestJson = 64;          ///< objects and arrays in each other

/// The first place at which a text goes beyond a limit.
struct Excess {
  size_t at = 0;     ///< byte
  std::string what;  ///< "elements are nested more than 200 deep"
};

std::optional<Excess> xml_excess(std::string_view text);
std::optional<Excess> toml_excess(std::string_view text);
/// `most_values`: of brackets and commas outside of strings; a value takes up to some 100 bytes.
std::optional<Excess> json_excess(std::string_view text, uint64_t most_values = UINT64_MAX);

/// Json::parse without exceptions; "discarded", too, of what nests too deep.
template <class Json>
Json parse_bounded(std::string_view text) {
  if (json_excess(text)) return Json(Json::value_t::discarded);
  return Json::parse(text, nullptr, false);
}

/// Line of a byte, from 1.
int line_at(std::string_view text, size_t at);

/// An excess as an error of `file` with its line; success where there is none.
Status check_excess(const std::optional<Excess>& excess, std::string_view text,
                    const std::string& file);

}  // namespace gloam
