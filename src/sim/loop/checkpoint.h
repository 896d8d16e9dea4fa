#pragma once
// The data behind gloam::Checkpoint: the record of a run up to an instant and, where nothing but
// MuJoCo, Commands and controllers that can be copied decides the future, a copy of the instant.

#include <memory>
#include <optional>
#include <vector>

#include "gloam/checkpoint.h"
#include "gloam/controller.h"
#include "sim/commands/applied_inputs.h"
#include "sim/loop/actuator_layer.h"
#include "sim/loop/controller_slot.h"
#include "sim/loop/run_record.h"
#include "sim/snapshots/snapshot.h"

namespace gloam {

/// A Stepper without effects at an instant.
struct StepperState {
  DataPtr data;
  AppliedInputs inputs;
  ActuatorLayers actuators;
  std::shared_ptr<const LiveFields> live;
  int64_t since = 0, step = 0;
  uint64_t hash = 0;
  std::vector<double> state, sensors;
  bool own_sensors = false;
  double sensor_stamp = 0;  ///< [s]
  std::array<int, mjNWARNING> warnings_seen{};
};

/// A SimLoop at an instant.
struct LoopState {
  std::unique_ptr<StepperState> stepper;
  std::vector<VelocityTarget> goals;
  std::vector<std::optional<Pose>> pose_goals;
  size_t scene_cursor = 0;
  std::vector<RobotControl> controllers;
};

struct CheckpointData {
  RunRecord record;
  double time = 0;                        ///< [s]
  std::shared_ptr<const LoopState> copy;  ///< null = it is stepped to again
};

}  // namespace gloam
