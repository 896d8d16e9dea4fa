// Functions and names of quantities in expressions: the rest of ExpressionParser.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "metrics/expression_parser.h"

namespace gloam {
namespace {

using Kind = ExpressionToken::Kind;
using Op = Instruction::Op;

Error refuse_call(const SourceLoc& loc, std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), loc, std::move(hint)};
}

constexpr int kLargestIndex = 1 << 20;

}  // namespace

Result<int> ExpressionParser::function(const ExpressionToken& word) {
  for (const ExpressionFunction& function : kExpressionFunctions)
    if (word.text == function.name) return arguments(function, word);
  const std::vector<std::string> heads = names_.words();
  if (std::ranges::find(heads, word.text) != heads.end()) return name(word);
  std::vector<std::string> known = heads;
  for (const ExpressionFunction& function : kExpressionFunctions) known.emplace_back(function.name);
  const std::string nearest = nearest_name(word.text, known);
  return refuse_call(word.loc, fmt::format("unknown function '{}'", word.text),
                     nearest.empty() ? "see docs/metrics.md for all functions"
                                     : fmt::format("did you mean '{}'?", nearest));
}

Result<int> ExpressionParser::arguments(const ExpressionFunction& function,
                                        const ExpressionToken& word) {
  GLOAM_TRY_STATUS(expect("("));
  std::vector<int> widths;
  while (true) {
    if (widths.empty() && at(")")) break;
    const SourceLoc loc = token_.loc;
    GLOAM_TRY(const int width, choice());
    widths.push_back(width);
    const auto count = static_cast<int>(widths.size());
    const bool takes_vectors =
        function.kind == FunctionKind::kNorm || function.kind == FunctionKind::kDot ||
        function.kind == FunctionKind::kCross || function.kind == FunctionKind::kDistance;
    const bool takes_any = function.kind == FunctionKind::kIf && count > 1;
    if (!takes_any && width != (takes_vectors ? 3 : 1))
      return refuse_call(loc, fmt::format("'{}' takes {}", function.name,
                                          takes_vectors ? "a vector as this argument"
                                                        : "a number as this argument"));
    if (function.kind == FunctionKind::kFold && count > 1) emit_call(function.call2, 1);
    if (!at(",") || count == function.most) break;
    GLOAM_TRY_STATUS(advance());
  }
  const auto count = static_cast<int>(widths.size());
  if (count < function.least || (count == function.most && at(",")))
    return refuse_call(word.loc, function.least == function.most
                                     ? fmt::format("'{}' takes {} argument{}", function.name,
                                                   function.least, function.least == 1 ? "" : "s")
                                     : fmt::format("'{}' takes {} to {} arguments", function.name,
                                                   function.least, function.most));
  GLOAM_TRY_STATUS(expect(")"));
  return finish_function(function, widths, word.loc);
}

Result<int> ExpressionParser::finish_function(const ExpressionFunction& function,
                                              const std::vector<int>& widths,
                                              const SourceLoc& loc) {
  switch (function.kind) {
    case FunctionKind::kOne:
      emit_call(function.call1, 1);
      return 1;
    case FunctionKind::kFold:
      return 1;
    case FunctionKind::kDistance:
      emit_call([](double a, double b) { return a - b; }, 3);
      [[fallthrough]];
    case FunctionKind::kNorm:
      emit({.op = Op::kNorm}, -2);
      return 1;
    case FunctionKind::kDot:
      emit({.op = Op::kDot}, -5);
      return 1;
    case FunctionKind::kCross:
      emit({.op = Op::kCross}, -3);
      return 3;
    case FunctionKind::kVector:
      return 3;
    case FunctionKind::kClamp:
      emit({.op = Op::kClamp}, -2);
      return 1;
    case FunctionKind::kIf:
      if (widths[1] != widths[2])
        return refuse_call(loc, "one value is a number, the other a vector");
      emit({.op = Op::kSelect, .width = widths[1]}, -widths[1] - 1);
      return widths[1];
  }
  return refuse_call(loc, "unknown kind of function");
}

Result<int> ExpressionParser::index() {
  GLOAM_TRY_STATUS(advance());
  const double number = token_.number;
  if (token_.kind != Kind::kNumber || number > kLargestIndex || number != std::floor(number))
    return refuse_call(token_.loc, "an index must be a whole number from 0");
  GLOAM_TRY_STATUS(advance());
  GLOAM_TRY_STATUS(expect("]"));
  return static_cast<int>(number);
}

// Behind its word.
Result<NameStep> ExpressionParser::name_step(const ExpressionToken& word) {
  NameStep step;
  step.word = word.text;
  step.loc = word.loc;
  if (at("(")) {
    step.is_call = true;
    GLOAM_TRY_STATUS(advance());
    while (!at(")")) {
      if (token_.kind != Kind::kText)
        return refuse_call(token_.loc, fmt::format("'{}' takes quoted names", word.text));
      step.arguments.emplace_back(token_.text);
      GLOAM_TRY_STATUS(advance());
      if (!at(")")) GLOAM_TRY_STATUS(expect(","));
    }
    GLOAM_TRY_STATUS(advance());
  }
  if (at("[")) {
    GLOAM_TRY(step.index, index());
  }
  return step;
}

Result<int> ExpressionParser::name(const ExpressionToken& word) {
  std::vector<NameStep> steps;
  GLOAM_TRY(NameStep first, name_step(word));
  steps.push_back(std::move(first));
  while (at(".")) {
    GLOAM_TRY_STATUS(advance());
    if (token_.kind != Kind::kWord) return unexpected();
    const ExpressionToken next = token_;
    GLOAM_TRY_STATUS(advance());
    GLOAM_TRY(NameStep step, name_step(next));
    steps.push_back(std::move(step));
  }
  GLOAM_TRY(const QuantitySlot slot, names_.find(steps));
  push({.op = Op::kLoad, .width = slot.width, .first = slot.first});
  return slot.width;
}

}  // namespace gloam
