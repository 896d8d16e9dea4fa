#pragma once
// Numbers that a metric's values over an episode come down to.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gloam {

class Reduction {
 public:
  /// A value and its time [s], in order; NaN is left out, and so is the time around it.
  void add(double time, double value);
  /// As [[metric]] `reduce`: "mean", "integral" …; empty = there was no value, or it was never
  /// true. The integral is by the trapezoidal rule.
  std::optional<double> get(std::string_view kind) const;
  int64_t count() const { return count_; }

 private:
  int64_t count_ = 0, true_ = 0;
  double sum_ = 0, square_ = 0, least_ = 0, most_ = 0, last_ = 0, integral_ = 0;
  double last_time_ = 0;  // of a value that the next one joins up with [s]
  bool joins_ = false;
  std::optional<double> first_true_ = {};  // [s]
};

/// Unit of what `kind` makes of values in `unit`.
std::string reduced_unit(std::string_view kind, const std::string& unit);

}  // namespace gloam
