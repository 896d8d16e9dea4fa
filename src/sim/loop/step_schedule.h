#pragma once
// Schedules in integers: which physics step an event of a given rate and phase falls on. Floating
// point enters once, when a timestep or time that a person wrote in decimals becomes a fraction.

#include <cstdint>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// The fraction with the smallest denominator that is nearest to `value` in double precision: 0.002
/// -> 1/500, and 1.0 / 3 -> 1/3. Denominators stay below 2^31. `value` finite, |value| < 1e9; below
/// 1e-9 becomes 0.
Rational exact_rational(double value);

/// First step at or after `time` [s].
int64_t step_at_or_after(Rational time, Rational timestep);

/// Steps at even distances that bracket a time span from its first step on.
struct KeySteps {
  static constexpr int kMost = 17;
  int count = 1;       ///< 1 … kMost; 1 = the span has no length
  int64_t stride = 1;  ///< steps from one to the next

  int64_t length() const { return (count - 1) * stride; }
};
/// The closest such steps for a span of `duration` >= 0 [s]: every step, of long spans every
/// second, third …
KeySteps key_steps(Rational duration, Rational timestep);

/// Events k = 0, 1, … at t_k = phase + k / rate. Event k falls on the first step at or after t_k:
/// where the rate does not divide the step rate, events are late by less than one step and never
/// drift. A rate above the step rate is refused, so no two events share a step.
class StepSchedule {
 public:
  /// Every step, from step 0.
  StepSchedule() = default;
  /// `rate` > 0 [Hz], `phase` >= 0 [s], `timestep` > 0 [s]; numbers up to 2^31.
  static Result<StepSchedule> make(Rational rate, Rational phase, Rational timestep);
  /// Of `rate` from step 0, or where steps are longer than that of every step.
  static StepSchedule at_most(Rational rate, Rational timestep);

  /// The step of event k >= 0.
  int64_t step_of(int64_t k) const;
  bool operator==(const StepSchedule&) const = default;
  /// By how much event k's step is later than t_k, 0 <= … < 1 [steps].
  double lateness_of(int64_t k) const;
  /// The first event at or after `step`.
  int64_t first_at_or_after(int64_t step) const;

 private:
  // t_k / timestep = (offset_ + k * stride_) / unit_.
  __int128 offset_ = 0, stride_ = 1, unit_ = 1;
};

}  // namespace gloam
