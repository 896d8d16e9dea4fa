#include "sim/loop/step_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"

namespace gloam {
namespace {

constexpr int64_t kLargest = int64_t{1} << 31;

__int128 ceil_div(__int128 a, __int128 b) { return a / b + (a % b > 0 ? 1 : 0); }

__int128 gcd(__int128 a, __int128 b) {
  while (b != 0) {
    const __int128 r = a % b;
    a = b;
    b = r;
  }
  return a < 0 ? -a : a;
}

bool in_range(Rational r) {
  return r.num >= 0 && r.num <= kLargest && r.den > 0 && r.den <= kLargest;
}

}  // namespace

Rational exact_rational(double value) {
  GLOAM_CHECK(std::isfinite(value) && std::abs(value) < 1e9,
              "a time must be finite and below 1e9 s");
  // Convergents of the continued fraction: each is the best approximation of its size, and the
  // first that rounds to `value` is the fraction that was meant.
  const double x = std::abs(value);
  if (x < 1e-9) return {0, 1};
  int64_t p0 = 0, q0 = 1, p1 = 1, q1 = 0;
  for (double rest = x;;) {
    const double whole = std::floor(rest);
    if (q1 != 0 && whole * static_cast<double>(q1) > static_cast<double>(kLargest)) break;
    const int64_t a = static_cast<int64_t>(whole);
    const int64_t p = a * p1 + p0, q = a * q1 + q0;
    p0 = p1, q0 = q1, p1 = p, q1 = q;
    if (static_cast<double>(p) / static_cast<double>(q) == x || rest == whole) break;
    rest = 1 / (rest - whole);
  }
  return {value < 0 ? -p1 : p1, q1};
}

int64_t step_at_or_after(Rational time, Rational timestep) {
  return static_cast<int64_t>(ceil_div(static_cast<__int128>(time.num) * timestep.den,
                                       static_cast<__int128>(time.den) * timestep.num));
}

KeySteps key_steps(Rational duration, Rational timestep) {
  const int64_t steps = step_at_or_after(duration, timestep);
  const int64_t most = KeySteps::kMost - 1;
  KeySteps keys;
  keys.stride = std::max<int64_t>((steps + most - 1) / most, 1);
  keys.count = static_cast<int>((steps + keys.stride - 1) / keys.stride) + 1;
  return keys;
}

Result<StepSchedule> StepSchedule::make(Rational rate, Rational phase, Rational timestep) {
  if (!in_range(rate) || rate.num == 0) {
    return Error{
        ErrorKind::kUsage,
        fmt::format("a rate of {}/{} Hz is not a positive number below 2^31", rate.num, rate.den)};
  }
  if (!in_range(phase)) {
    return Error{ErrorKind::kUsage,
                 fmt::format("a phase of {}/{} s is negative or too large", phase.num, phase.den)};
  }
  GLOAM_CHECK(timestep.num > 0 && timestep.den > 0, "the timestep must be positive");
  StepSchedule schedule;
  schedule.offset_ = static_cast<__int128>(phase.num) * rate.num * timestep.den;
  schedule.stride_ = static_cast<__int128>(rate.den) * phase.den * timestep.den;
  schedule.unit_ = static_cast<__int128>(phase.den) * rate.num * timestep.num;
  const __int128 common = gcd(gcd(schedule.offset_, schedule.stride_), schedule.unit_);
  schedule.offset_ /= common, schedule.stride_ /= common, schedule.unit_ /= common;
  if (schedule.stride_ < schedule.unit_) {
    return Error{ErrorKind::kUsage,
                 fmt::format("a rate of {:g} Hz is above the simulation's step rate of {:g} Hz",
                             rate.value(), 1 / timestep.value()),
                 {},
                 "reduce the rate or the timestep"};
  }
  return schedule;
}

StepSchedule StepSchedule::at_most(Rational rate, Rational timestep) {
  const Result<StepSchedule> schedule = make(rate, {0, 1}, timestep);
  return schedule.ok() ? *schedule : StepSchedule();
}

int64_t StepSchedule::step_of(int64_t k) const {
  if (unit_ == 1) return static_cast<int64_t>(offset_ + k * stride_);  // no slow 128-bit division
  return static_cast<int64_t>(ceil_div(offset_ + k * stride_, unit_));
}

double StepSchedule::lateness_of(int64_t k) const {
  const __int128 beyond = (offset_ + k * stride_) % unit_;
  return beyond == 0 ? 0 : static_cast<double>(unit_ - beyond) / static_cast<double>(unit_);
}

int64_t StepSchedule::first_at_or_after(int64_t step) const {
  // ceil(t_k / timestep) >= step  <=>  t_k / timestep > step - 1.
  const __int128 reach = (static_cast<__int128>(step) - 1) * unit_ - offset_;
  return reach < 0 ? 0 : static_cast<int64_t>(reach / stride_) + 1;
}

}  // namespace gloam
