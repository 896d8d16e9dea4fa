#pragma once
// Recursive descent over an expression; writes the program as it goes.

#include <optional>
#include <string_view>
#include <vector>

#include "metrics/expression_functions.h"
#include "metrics/expression_lexer.h"

namespace gloam {

// choice     = either [ "?" choice ":" choice ]
// either     = both { "or" both }
// both       = negation { "and" negation }
// negation   = "not" negation | comparison
// comparison = sum [ ("<" | "<=" | ">" | ">=" | "==" | "!=") sum ]
// sum        = product { ("+" | "-") product }
// product    = signed { ("*" | "/") signed }
// signed     = ("-" | "+") signed | power
// power      = element [ "^" signed ]
// element    = ( number | "(" choice ")" | function "(" choice … ")" | name ) { "." ("x"|"y"|"z") }
// name       = step { "." step };  step = word [ "(" [ text … ] ")" ] [ "[" number "]" ]
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, QuantityNames& names)
      : text_(text), lexer_(text), names_(names) {}
  Result<Expression> parse();

 private:
  /// Numbers of a part's value: 1, or 3 of a vector.
  using Width = Result<int>;

  Width choice();
  Width either();
  Width both();
  Width negation();
  Width comparison();
  Width sum();
  Width product();
  Width sign();
  Width power();
  Width element();
  Width primary();
  Width function(const ExpressionToken& word);
  Width arguments(const ExpressionFunction& function, const ExpressionToken& word);
  Width finish_function(const ExpressionFunction& function, const std::vector<int>& widths,
                        const SourceLoc& loc);
  Width name(const ExpressionToken& word);
  Result<NameStep> name_step(const ExpressionToken& word);
  Result<int> index();
  Width chain(Width (ExpressionParser::*part)(), std::string_view word,
              double (*call)(double, double));
  Width multiply(int left, int right, bool divide, const SourceLoc& loc);

  Status advance();
  bool at(std::string_view sign_or_word) const;
  Status expect(std::string_view sign);
  Status want_number(int width, const SourceLoc& loc, std::string_view what) const;
  Error unexpected() const;
  Status deeper();
  void push(const Instruction& instruction);
  void emit(const Instruction& instruction, int change);
  void emit_call(double (*call)(double), int width);
  void emit_call(double (*call)(double, double), int width);

  std::string_view text_;
  ExpressionLexer lexer_;
  ExpressionToken token_;
  QuantityNames& names_;
  Expression out_;
  int depth_ = 0, height_ = 0, highest_ = 0;  // of recursion; of the stack
};

}  // namespace gloam
