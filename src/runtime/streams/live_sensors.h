#pragma once
// MuJoCo's sensors of a running simulation: a thread that turns Snapshots into messages.

#include <memory>
#include <string>
#include <vector>

#include "gloam/sensor.h"
#include "runtime/streams/stream_thread.h"
#include "sensors/sensor_group.h"
#include "sim/loop/simulator.h"

namespace gloam {

class LiveSensors final : public SensorStream {
 public:
  /// Errors: no such sensor, SensorGroup's.
  static Result<std::unique_ptr<LiveSensors>> open(Simulator& simulator,
                                                   const std::vector<std::string>& sensors,
                                                   bool required, uint64_t seed,
                                                   SensorCallback on_message,
                                                   EndCallback on_end = {});
  int64_t dropped() const override { return thread_.dropped(); }
  Status status() const override { return thread_.status(); }
  /// Waits until the simulation has stopped and every message was delivered.
  void drain() { thread_.drain(); }

 private:
  LiveSensors(std::vector<std::string> names, uint64_t seed, SensorCallback on_message)
      : names_(std::move(names)), seed_(seed), on_message_(std::move(on_message)) {}
  Result<SensorGroup> group_of(const CompiledWorld& world, Rational timestep) const;
  Status sample(const Snapshot& snapshot, Rational timestep);

  const std::vector<std::string> names_;
  const uint64_t seed_;
  SensorCallback on_message_;
  // World whose Snapshots come; holds the group's options
  std::shared_ptr<const CompiledWorld> world_;
  SensorGroup group_;
  StreamThread thread_;  // last: it uses the others
};

}  // namespace gloam
