#pragma once
// Words, numbers and signs of an expression.

#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam {

struct ExpressionToken {
  enum class Kind { kNumber, kWord, kText, kSign, kEnd };
  Kind kind = Kind::kEnd;
  std::string_view text;  ///< as written; of kText without its quotes
  double number = 0;
  SourceLoc loc;  ///< line and column, from 1
};

class ExpressionLexer {
 public:
  explicit ExpressionLexer(std::string_view text) : text_(text) {}
  /// Error: a character that none begins with, a quote that does not end, a number too large.
  Result<ExpressionToken> next();

 private:
  void skip_space();
  void take(size_t bytes);
  Result<ExpressionToken> number(ExpressionToken token);
  Result<ExpressionToken> quoted(ExpressionToken token);

  std::string_view text_;
  size_t at_ = 0;
  int line_ = 1, column_ = 1;
};

}  // namespace gloam
