#include "metrics/reduction.h"

#include <algorithm>
#include <cmath>

namespace gloam {

void Reduction::add(double time, double value) {
  if (std::isnan(value)) {
    joins_ = false;
    return;
  }
  if (joins_) integral_ += 0.5 * (last_ + value) * (time - last_time_);
  least_ = count_ == 0 ? value : std::min(least_, value);
  most_ = count_ == 0 ? value : std::max(most_, value);
  sum_ += value;
  square_ += value * value;
  ++count_;
  if (value != 0) {
    ++true_;
    if (!first_true_) first_true_ = time;
  }
  last_ = value;
  last_time_ = time;
  joins_ = true;
}

std::optional<double> Reduction::get(std::string_view kind) const {
  if (count_ == 0) return {};
  const auto n = static_cast<double>(count_);
  if (kind == "last") return last_;
  if (kind == "mean") return sum_ / n;
  if (kind == "min") return least_;
  if (kind == "max") return most_;
  if (kind == "rms") return std::sqrt(square_ / n);
  if (kind == "sum") return sum_;
  if (kind == "integral") return integral_;
  if (kind == "first_time_true") return first_true_;
  if (kind == "fraction_true") return static_cast<double>(true_) / n;
  return {};
}

std::string reduced_unit(std::string_view kind, const std::string& unit) {
  if (kind == "first_time_true") return "s";
  if (kind == "fraction_true") return "";
  if (kind == "integral") return unit.empty() ? "s" : unit + " s";
  return unit;
}

}  // namespace gloam
