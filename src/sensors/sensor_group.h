#pragma once
// MuJoCo's sensors as messages: which samples a Snapshot holds, and their errors.

#include <functional>
#include <memory>
#include <vector>

#include "gloam/sensor.h"
#include "sensors/signal/signal_model.h"
#include "sensors/timing.h"
#include "sim/snapshots/snapshot.h"
#include "world/sensors/sensor_description.h"

namespace gloam {

class SensorGroup {
 public:
  /// A sensor without a [[sensor]] has no errors and a sample at every step. Errors: a rate or
  /// jitter that the timestep does not allow.
  static Result<SensorGroup> make(const std::vector<SensorDescription>& sensors, Rational timestep,
                                  uint64_t simulation_seed);

  /// For SubscriptionOptions::due: the steps at which at least one of them has a sample.
  std::function<int64_t(int64_t step)> due() const;

  /// True if `other` takes its samples at the same steps.
  bool same_steps(const SensorGroup& other) const;

  /// Calls `deliver` with every sample that was taken at the Snapshot's step and is not dropped.
  /// A Snapshot before the last one begins anew.
  void sample(const Snapshot& snapshot, const SensorCallback& deliver);

 private:
  struct Member {
    SensorDescription description;
    SensorTiming timing;
    std::unique_ptr<SignalModel> model;  // null: the truth
    SensorMessage message;               // its memory is used again
  };
  std::vector<Member> members_;
};

}  // namespace gloam
