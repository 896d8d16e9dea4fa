#pragma once
// Sensors of an instant as messages, MuJoCo's and probes: which samples a Snapshot holds, and their
// errors.

#include <functional>
#include <memory>
#include <vector>

#include "gloam/sensor.h"
#include "sensors/probe/probe.h"
#include "sensors/signal/signal_model.h"
#include "sensors/timing.h"
#include "sim/snapshots/snapshot.h"
#include "world/sensors/sensor_description.h"

namespace gloam {

class SensorGroup {
 public:
  /// A sensor without a [[sensor]] has no errors and, if it is no probe, a sample at every step.
  /// Errors: a rate or jitter that the timestep does not allow.
  static Result<SensorGroup> make(const std::vector<SensorDescription>& sensors, Rational timestep,
                                  uint64_t simulation_seed);
  /// Makes the readers of its probes, before the first sample. Error: one needs what is not there.
  Status open_probes(const std::shared_ptr<const CompiledWorld>& world,
                     const ProbeSources& sources);

  /// For SubscriptionOptions::due: the steps whose Snapshots hold a sample of at least one of them
  /// that was taken at a step which is `used`: the first such step at or after the one given; empty
  /// = all are. Where a sensor's samples and the used steps hardly ever meet, some Snapshots
  /// without a sample are among them: nothing is delivered then.
  std::function<int64_t(int64_t step)> due(std::function<int64_t(int64_t step)> used = {}) const;

  /// True if `other` takes its samples at the same steps.
  bool same_steps(const SensorGroup& other) const;

  /// Calls `deliver` with every sample that the Snapshot holds and that is not dropped.
  /// A Snapshot before the last one begins anew. Error: a probe that cannot be read.
  Status sample(const Snapshot& snapshot, const SensorCallback& deliver);

 private:
  struct Member {
    SensorDescription description;
    SensorTiming timing;
    std::unique_ptr<SignalModel> model;  // null: the truth
    ProbeReader read;                    // of a probe, else empty
    SensorMessage message;               // its memory is used again
    /// Steps between a sample and the Snapshot that holds it. MuJoCo computes its sensors in the
    /// step that follows, from the state before: a sample has the stamp of its own step, as topics
    /// of poses have, and comes with the next Snapshot.
    int64_t lag() const { return description.probe >= 0 ? 0 : 1; }
  };
  Status read(const Snapshot& snapshot, Member* member);

  std::vector<Member> members_;
  std::unique_ptr<ProbeInstant> instant_;  // null: there are no probes
};

}  // namespace gloam
