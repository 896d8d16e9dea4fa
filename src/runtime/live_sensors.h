#pragma once
// MuJoCo's sensors of a running simulation: a thread that turns Snapshots into messages.

#include <memory>
#include <thread>
#include <vector>

#include "gloam/sensor.h"
#include "sensors/sensor_group.h"
#include "sim/simulator.h"

namespace gloam {

class LiveSensors final : public SensorStream {
 public:
  /// Errors: SensorGroup's.
  static Result<std::unique_ptr<LiveSensors>> open(Simulator& simulator,
                                                   const std::vector<SensorDescription>& sensors,
                                                   bool required, uint64_t seed,
                                                   SensorCallback on_message);
  ~LiveSensors() override;
  int64_t dropped() const override { return queue_->dropped(); }
  /// Waits until the simulation has stopped and every message was delivered.
  void drain();

 private:
  LiveSensors(SensorGroup group, SensorCallback on_message)
      : group_(std::move(group)), on_message_(std::move(on_message)) {}

  SensorGroup group_;
  SensorCallback on_message_;
  std::shared_ptr<SnapshotQueue> queue_;
  std::thread thread_;
};

/// The sensor of this name. Error: there is none.
Result<SensorDescription> find_sensor(const CompiledWorld& world, const std::string& name);

}  // namespace gloam
