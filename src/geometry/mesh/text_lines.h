#pragma once
// Text files of numbers, in pieces that can be read side by side.

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gloam {

inline std::string_view as_text(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline constexpr size_t kPieceBytes = size_t{1} << 20;  ///< size that one thread reads

/// Pieces of about `size` bytes that end behind a line; a line that ends with a backslash and the
/// next one stay together.
inline std::vector<std::string_view> split_at_lines(std::string_view text, size_t size) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    size_t end = text.find('\n', std::min(size, text.size()));
    while (end != std::string_view::npos && end > 0 &&
           (text[end - 1] == '\\' || (end > 1 && text[end - 1] == '\r' && text[end - 2] == '\\')))
      end = text.find('\n', end + 1);
    const size_t length = end == std::string_view::npos ? text.size() : end + 1;
    out.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return out;
}

/// Takes the next line off `rest`, without its end.
inline std::string_view take_line(std::string_view* rest) {
  const size_t end = rest->find('\n');
  std::string_view line = rest->substr(0, end);
  rest->remove_prefix(end == std::string_view::npos ? rest->size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

inline std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Takes the next word off `line`; empty at its end.
inline std::string_view take_word(std::string_view* line) {
  size_t begin = 0;
  while (begin < line->size() && is_blank((*line)[begin])) ++begin;
  size_t end = begin;
  while (end < line->size() && !is_blank((*line)[end])) ++end;
  const std::string_view word = line->substr(begin, end - begin);
  line->remove_prefix(end);
  return word;
}

/// The whole word as a number. What is too small for a float is 0, too large infinity; "nan" and
/// "inf" are numbers too: who takes them checks.
inline bool parse_number(std::string_view word, float* out) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, code] = std::from_chars(word.data(), end, *out);
  if (stop != end || word.empty()) return false;
  if (code == std::errc::result_out_of_range)
    *out = static_cast<float>(std::strtod(std::string(word).c_str(), nullptr));
  return true;
}

template <class Integer>
bool parse_integer(std::string_view word, Integer* out) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, code] = std::from_chars(word.data(), end, *out);
  return code == std::errc() && stop == end && !word.empty();
}

}  // namespace gloam
