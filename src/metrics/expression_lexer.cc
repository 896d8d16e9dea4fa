#include "metrics/expression_lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/text.h"

namespace gloam {
namespace {

using Kind = ExpressionToken::Kind;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

constexpr std::string_view kTwoCharacters[] = {"<=", ">=", "==", "!="};
constexpr std::string_view kOneCharacter = "+-*/^<>?:(),.[]";

// Operators of other languages, and their equivalents here.
struct ForeignSign {
  std::string_view sign, instead;
};
constexpr ForeignSign kForeignSigns[] = {{"&&", "and"},     {"||", "or"}, {"!", "not"},
                                         {"&", "and"},      {"|", "or"},  {"=", "=="},
                                         {"%", "mod(a, b)"}};

}  // namespace

void ExpressionLexer::take(size_t bytes) {
  for (size_t i = 0; i < bytes; ++i, ++at_) {
    const bool starts_character = (static_cast<unsigned char>(text_[at_]) & 0xc0) != 0x80;
    if (text_[at_] == '\n') {
      ++line_;
      column_ = 1;
    } else if (starts_character) {
      ++column_;
    }
  }
}

void ExpressionLexer::skip_space() {
  while (at_ < text_.size() &&
         (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
    take(1);
}

Result<ExpressionToken> ExpressionLexer::next() {
  skip_space();
  ExpressionToken token;
  token.loc = {"", line_, column_};
  if (at_ == text_.size()) return token;
  const char c = text_[at_];
  const bool has_digit = at_ + 1 < text_.size() && is_digit(text_[at_ + 1]);
  if (is_digit(c) || (c == '.' && has_digit)) return number(token);
  if (c == '"' || c == '\'') return quoted(token);
  const std::string_view rest = text_.substr(at_);
  if (is_letter(c)) {
    size_t length = 1;
    while (length < rest.size() && (is_letter(rest[length]) || is_digit(rest[length]))) ++length;
    token.kind = Kind::kWord;
    token.text = rest.substr(0, length);
    take(length);
    return token;
  }
  token.kind = Kind::kSign;
  for (const std::string_view sign : kTwoCharacters) {
    if (rest.starts_with(sign)) token.text = rest.substr(0, 2);
  }
  if (token.text.empty() && kOneCharacter.find(c) != std::string_view::npos)
    token.text = rest.substr(0, 1);
  if (token.text.empty()) {
    for (const auto& [sign, instead] : kForeignSigns) {
      if (!rest.starts_with(sign)) continue;
      return Error{ErrorKind::kInput, fmt::format("unknown operator '{}'", sign), token.loc,
                   fmt::format("use '{}'", instead)};
    }
    const size_t bytes = std::max<size_t>(1, utf8_length(rest));
    return Error{ErrorKind::kInput,
                 fmt::format("unexpected character '{}'", as_utf8(rest.substr(0, bytes))),
                 token.loc};
  }
  take(token.text.size());
  return token;
}

Result<ExpressionToken> ExpressionLexer::number(ExpressionToken token) {
  const char* begin = text_.data() + at_;
  const auto [end, code] = std::from_chars(begin, text_.data() + text_.size(), token.number);
  token.kind = Kind::kNumber;
  token.text = {begin, static_cast<size_t>(end - begin)};
  if (code != std::errc())
    return Error{ErrorKind::kInput, fmt::format("'{}' is out of range", token.text), token.loc};
  take(token.text.size());
  if (at_ < text_.size() && is_letter(text_[at_]))
    return Error{ErrorKind::kInput,
                 fmt::format("'{}{}' is neither a number nor a name", token.text, text_[at_]),
                 token.loc, "write '*' between a number and a name"};
  return token;
}

Result<ExpressionToken> ExpressionLexer::quoted(ExpressionToken token) {
  const size_t end = text_.find(text_[at_], at_ + 1);
  if (end == std::string_view::npos)
    return Error{ErrorKind::kInput, "unterminated string", token.loc};
  token.kind = Kind::kText;
  token.text = text_.substr(at_ + 1, end - at_ - 1);
  take(end + 1 - at_);
  return token;
}

}  // namespace gloam
