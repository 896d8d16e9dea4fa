#include "metrics/expression_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "metrics/expression_operators.h"

namespace gloam {
namespace {

using Kind = ExpressionToken::Kind;
using Op = Instruction::Op;

Error refuse(const SourceLoc& loc, std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), loc, std::move(hint)};
}

}  // namespace

Result<Expression> Expression::parse(std::string_view text, QuantityNames& names) {
  if (text.size() > kLongest)
    return refuse({"", 1, 1}, fmt::format("the expression has {} characters; the limit is {}",
                                          text.size(), kLongest));
  return ExpressionParser(text, names).parse();
}

Result<Expression> ExpressionParser::parse() {
  GLOAM_TRY_STATUS(advance());
  const SourceLoc start = token_.loc;
  GLOAM_TRY(const int width, choice());
  if (token_.kind != Kind::kEnd) return unexpected();
  GLOAM_TRY_STATUS(want_number(width, start, "the value of a metric"));
  out_.stack_.resize(static_cast<size_t>(highest_));
  return std::move(out_);
}

Status ExpressionParser::advance() {
  GLOAM_TRY(token_, lexer_.next());
  return {};
}

bool ExpressionParser::at(std::string_view sign_or_word) const {
  return (token_.kind == Kind::kSign || token_.kind == Kind::kWord) && token_.text == sign_or_word;
}

Status ExpressionParser::expect(std::string_view sign) {
  if (at(sign)) return advance();
  Error error = unexpected();
  error.hint = fmt::format("expected '{}'", sign);
  return error;
}

Error ExpressionParser::unexpected() const {
  if (token_.kind == Kind::kEnd) return refuse(token_.loc, "unexpected end of the expression");
  return refuse(token_.loc, fmt::format("unexpected '{}'", as_utf8(token_.text)));
}

Status ExpressionParser::want_number(int width, const SourceLoc& loc, std::string_view what) const {
  if (width == 1) return {};
  return refuse(loc, fmt::format("{} must be a number, not a vector", what),
                "use norm(…), or a component .x, .y or .z");
}

Status ExpressionParser::deeper() {
  if (++depth_ <= Expression::kMaxDepth) return {};
  return refuse(token_.loc,
                fmt::format("the expression is nested more than {} deep", Expression::kMaxDepth));
}

void ExpressionParser::emit(const Instruction& instruction, int change) {
  out_.program_.push_back(instruction);
  height_ += change;
  highest_ = std::max(highest_, height_);
}
void ExpressionParser::push(const Instruction& instruction) {
  emit(instruction, instruction.width);
}
void ExpressionParser::emit_call(double (*call)(double), int width) {
  emit({.op = Op::kCall1, .width = width, .call1 = call}, 0);
}
void ExpressionParser::emit_call(double (*call)(double, double), int width) {
  emit({.op = Op::kCall2, .width = width, .call2 = call}, -width);
}

Result<int> ExpressionParser::choice() {
  GLOAM_TRY_STATUS(deeper());
  const SourceLoc loc = token_.loc;
  GLOAM_TRY(int width, either());
  if (at("?")) {
    GLOAM_TRY_STATUS(want_number(width, loc, "a condition"));
    GLOAM_TRY_STATUS(advance());
    const SourceLoc values = token_.loc;
    GLOAM_TRY(width, choice());
    GLOAM_TRY_STATUS(expect(":"));
    GLOAM_TRY(const int other, choice());
    if (width != other) return refuse(values, "one value is a number, the other a vector");
    emit({.op = Op::kSelect, .width = width}, -width - 1);
  }
  --depth_;
  return width;
}

Result<int> ExpressionParser::chain(Width (ExpressionParser::*part)(), std::string_view word,
                                    double (*call)(double, double)) {
  const SourceLoc loc = token_.loc;
  GLOAM_TRY(int width, (this->*part)());
  while (at(word)) {
    GLOAM_TRY_STATUS(want_number(width, loc, fmt::format("the left operand of '{}'", word)));
    GLOAM_TRY_STATUS(advance());
    const SourceLoc right = token_.loc;
    GLOAM_TRY(width, (this->*part)());
    GLOAM_TRY_STATUS(want_number(width, right, fmt::format("the right operand of '{}'", word)));
    emit_call(call, 1);
  }
  return width;
}

Result<int> ExpressionParser::either() {
  return chain(&ExpressionParser::both, "or", expression::is_either);
}
Result<int> ExpressionParser::both() {
  return chain(&ExpressionParser::negation, "and", expression::is_both);
}

Result<int> ExpressionParser::negation() {
  if (!at("not")) return comparison();
  GLOAM_TRY_STATUS(deeper());
  GLOAM_TRY_STATUS(advance());
  const SourceLoc loc = token_.loc;
  GLOAM_TRY(const int width, negation());
  GLOAM_TRY_STATUS(want_number(width, loc, "the operand of 'not'"));
  emit_call(expression::is_untrue, 1);
  --depth_;
  return 1;
}

Result<int> ExpressionParser::comparison() {
  const auto find = [&]() -> const expression::Comparison* {
    for (const expression::Comparison& comparison : expression::kComparisons)
      if (at(comparison.sign)) return &comparison;
    return nullptr;
  };
  const SourceLoc left = token_.loc;
  GLOAM_TRY(int width, sum());
  const expression::Comparison* comparison = find();
  if (comparison == nullptr) return width;
  GLOAM_TRY_STATUS(want_number(width, left, "a compared value"));
  GLOAM_TRY_STATUS(advance());
  const SourceLoc right = token_.loc;
  GLOAM_TRY(width, sum());
  GLOAM_TRY_STATUS(want_number(width, right, "a compared value"));
  emit_call(comparison->call, 1);
  if (find() != nullptr)
    return refuse(token_.loc, "comparisons cannot be chained", "write 'a < b and b < c'");
  return 1;
}

Result<int> ExpressionParser::sum() {
  GLOAM_TRY(int width, product());
  while (at("+") || at("-")) {
    const auto call = at("+") ? expression::add : expression::subtract;
    const SourceLoc loc = token_.loc;
    GLOAM_TRY_STATUS(advance());
    GLOAM_TRY(const int right, product());
    if (right != width)
      return refuse(loc, fmt::format("'{}' cannot combine a number and a vector",
                                     call == expression::add ? '+' : '-'));
    emit_call(call, width);
  }
  return width;
}

Result<int> ExpressionParser::product() {
  GLOAM_TRY(int width, sign());
  while (at("*") || at("/")) {
    const bool divides = at("/");
    const SourceLoc loc = token_.loc;
    GLOAM_TRY_STATUS(advance());
    GLOAM_TRY(const int right, sign());
    GLOAM_TRY(width, multiply(width, right, divides, loc));
  }
  return width;
}

Result<int> ExpressionParser::multiply(int left, int right, bool divides, const SourceLoc& loc) {
  if (left == 1 && right == 1) {
    emit_call(divides ? expression::divide : expression::multiply_numbers, 1);
    return 1;
  }
  if (divides && right == 3) return refuse(loc, "cannot divide by a vector");
  if (left == 3 && right == 3)
    return refuse(loc, "'*' cannot combine two vectors", "use dot(a, b) or cross(a, b)");
  emit({.op = left == 1 ? Op::kScaleLeft : divides ? Op::kDivide : Op::kScale}, -1);
  return 3;
}

Result<int> ExpressionParser::sign() {
  if (!at("-") && !at("+")) return power();
  const bool negative = at("-");
  GLOAM_TRY_STATUS(deeper());
  GLOAM_TRY_STATUS(advance());
  GLOAM_TRY(const int width, sign());
  if (negative) emit_call(expression::negate, width);
  --depth_;
  return width;
}

Result<int> ExpressionParser::power() {
  const SourceLoc loc = token_.loc;
  GLOAM_TRY(const int width, element());
  if (!at("^")) return width;
  GLOAM_TRY_STATUS(want_number(width, loc, "the base of a power"));
  GLOAM_TRY_STATUS(deeper());
  GLOAM_TRY_STATUS(advance());
  const SourceLoc right = token_.loc;
  GLOAM_TRY(const int exponent, sign());
  GLOAM_TRY_STATUS(want_number(exponent, right, "the exponent of a power"));
  emit_call([](double a, double b) { return std::pow(a, b); }, 1);
  --depth_;
  return 1;
}

Result<int> ExpressionParser::element() {
  GLOAM_TRY(int width, primary());
  while (at(".")) {
    GLOAM_TRY_STATUS(advance());
    const size_t axis = token_.kind == Kind::kWord && token_.text.size() == 1
                            ? std::string_view("xyz").find(token_.text)
                            : std::string_view::npos;
    if (axis == std::string_view::npos || width != 3) return unexpected();
    GLOAM_TRY_STATUS(advance());
    emit({.op = Op::kPick, .first = static_cast<int>(axis)}, -2);
    width = 1;
  }
  return width;
}

Result<int> ExpressionParser::primary() {
  if (at("(")) {
    GLOAM_TRY_STATUS(advance());
    GLOAM_TRY(const int width, choice());
    GLOAM_TRY_STATUS(expect(")"));
    return width;
  }
  const ExpressionToken token = token_;
  if (token.kind == Kind::kNumber) {
    GLOAM_TRY_STATUS(advance());
    push({.op = Op::kNumber, .number = token.number});
    return 1;
  }
  if (token.kind != Kind::kWord) return unexpected();
  for (const std::string_view keyword : {"and", "or", "not"})
    if (token.text == keyword) return unexpected();
  GLOAM_TRY_STATUS(advance());
  for (const expression::NamedConstant& constant : expression::kConstants) {
    if (token.text != constant.name) continue;
    push({.op = Op::kNumber, .number = constant.value});
    return 1;
  }
  if (at("(")) return function(token);
  return name(token);
}

}  // namespace gloam
