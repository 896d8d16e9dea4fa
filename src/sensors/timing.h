#pragma once
// When a sensor takes its samples and when they arrive: a pure function of (seed, sensor, number of
// the sample), so it goes on in the same way whether or not anyone subscribes.

#include <functional>
#include <string>

#include "gloam/result.h"
#include "gloam/scene/imager.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

/// When sample k arrives that was taken at `time` [s]; never before it, and in order.
double delivery_time(const TimingOptions& options, uint64_t seed, int64_t k, double time);

class SensorTiming {
 public:
  /// `seed` is the sensor's own: of the simulation's seed and its name. Errors: a rate above the
  /// step rate; a jitter of more than an eighth of what a period has beyond a timestep, or a
  /// jitter of the latency of more than an eighth of a period, by which samples would change order.
  static Result<SensorTiming> make(Rational rate, const TimingOptions& options, Rational timestep,
                                   uint64_t seed);

  /// Physics step of sample k >= 0; grows strictly with k.
  int64_t step_of(int64_t k) const;
  /// The first sample at or after `step`.
  int64_t first_at_or_after(int64_t step) const;
  /// The sample at `step`, or where there is none the last one before it; -1 = none yet.
  int64_t last_at_or_before(int64_t step) const { return first_at_or_after(step + 1) - 1; }
  /// True if `other` takes its samples at the same steps.
  bool same_steps(const SensorTiming& other) const {
    return schedule_ == other.schedule_ && seed_ == other.seed_ &&
           options_.jitter == other.options_.jitter;
  }
  /// True if sample k is lost.
  bool dropped(int64_t k) const;
  /// delivery_time() of sample k.
  double delivery_of(int64_t k, double time) const {
    return delivery_time(options_, seed_, k, time);
  }

 private:
  StepSchedule schedule_;
  TimingOptions options_;
  double timestep_ = 1;  // [s]
  uint64_t seed_ = 0;
};

/// For SubscriptionOptions::due.
std::function<int64_t(int64_t step)> due_steps(const SensorTiming& timing);

/// The seed of a sensor.
uint64_t sensor_seed(uint64_t simulation_seed, const std::string& name);

}  // namespace gloam
