#pragma once
// MuJoCo's sensors of a running simulation: a thread that turns Snapshots into messages.

#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gloam/sensor.h"
#include "sensors/sensor_group.h"
#include "sim/loop/simulator.h"

namespace gloam {

class LiveSensors final : public SensorStream {
 public:
  /// Errors: no such sensor, SensorGroup's.
  static Result<std::unique_ptr<LiveSensors>> open(Simulator& simulator,
                                                   const std::vector<std::string>& sensors,
                                                   bool required, uint64_t seed,
                                                   SensorCallback on_message);
  ~LiveSensors() override;
  int64_t dropped() const override { return queue_->dropped(); }
  Status status() const override;
  /// Waits until the simulation has stopped and every message was delivered.
  void drain();

 private:
  LiveSensors(std::vector<std::string> names, uint64_t seed, SensorCallback on_message)
      : names_(std::move(names)), seed_(seed), on_message_(std::move(on_message)) {}
  Result<SensorGroup> group_of(const CompiledWorld& world, Rational timestep) const;
  void run(Rational timestep);

  const std::vector<std::string> names_;
  const uint64_t seed_;
  SensorCallback on_message_;
  std::shared_ptr<const CompiledWorld> world_;  // whose Snapshots come; holds the group's options
  SensorGroup group_;
  std::shared_ptr<SnapshotQueue> queue_;
  mutable std::mutex mutex_;
  Status status_;
  std::thread thread_;
};

}  // namespace gloam
