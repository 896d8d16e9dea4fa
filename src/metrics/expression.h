#pragma once
// Expressions of metrics: numbers, vectors of three, comparisons, names of quantities
// (docs/metrics.md). Text becomes a flat program once, which is evaluated without allocating.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// A step of a quantity's name: `body("ada/trunk")`, `velocity`, `sensor("force")[2]`.
struct NameStep {
  std::string word;
  bool is_call = false;  ///< has parentheses
  std::vector<std::string> arguments;
  int index = -1;  ///< number in brackets; -1 = there is none
  SourceLoc loc;   ///< in the expression: line and column
};

/// Place of a quantity's numbers among the inputs of an evaluation.
struct QuantitySlot {
  int first = 0;
  int width = 1;  ///< 1, or 3 of a vector
};

/// Table of names that expressions may hold.
class QuantityNames {
 public:
  virtual ~QuantityNames() = default;
  /// Error: there is no such quantity, with the place of the step at fault.
  virtual Result<QuantitySlot> find(std::span<const NameStep> name) = 0;
  /// First words of names, to suggest.
  virtual std::vector<std::string> words() const = 0;
};

/// Instruction of a stack machine over doubles; a vector is three of them.
struct Instruction {
  enum class Op : uint8_t {
    kNumber,     ///< pushes `number`
    kLoad,       ///< pushes inputs `first` … `first + width - 1`
    kCall1,      ///< replaces each of `width` numbers by call1 of it
    kCall2,      ///< replaces two of `width` by call2 of both, number by number
    kScale,      ///< vector, number -> vector
    kScaleLeft,  ///< number, vector -> vector
    kDivide,     ///< vector, number -> vector
    kNorm,       ///< vector -> number
    kDot,        ///< vector, vector -> number
    kCross,      ///< vector, vector -> vector
    kClamp,      ///< number, low, high -> number
    kSelect,     ///< condition, two of `width` -> one of them
    kPick,       ///< vector -> its number `first`
  };
  Op op = Op::kNumber;
  int width = 1;
  int first = 0;
  double number = 0;
  double (*call1)(double) = nullptr;
  double (*call2)(double, double) = nullptr;
};

class Expression {
 public:
  static constexpr size_t kLongest = 4096;  ///< characters
  static constexpr int kMaxDepth = 64;      ///< parentheses and operators within each other

  /// Compiles a text whose value is one number. Error: its place in the text (line and column),
  /// and what may have been meant.
  static Result<Expression> parse(std::string_view text, QuantityNames& names);

  /// Value for the inputs that QuantityNames gave places to. NaN where an operand is NaN, but that
  /// of a choice not taken. Truth is 1, untruth 0.
  double evaluate(std::span<const double> inputs);

 private:
  friend class ExpressionParser;
  std::vector<Instruction> program_;
  std::vector<double> stack_;
};

/// "in column 7", or in texts of several lines "in line 2, column 7".
std::string place_in_expression(const SourceLoc& loc, std::string_view text);

}  // namespace gloam
