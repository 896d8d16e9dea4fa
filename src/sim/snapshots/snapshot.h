#pragma once
// The data behind gloam::Snapshot.

#include <mujoco/mujoco.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "gloam/joints/joint_trajectory.h"
#include "gloam/snapshot.h"
#include "sim/effects/effect_outputs.h"
#include "sim/snapshots/actuator_outputs.h"

namespace gloam {

/// Private copies of the model fields that have been changed by Command. Shared and immutable: a
/// change makes a new one.
struct LiveFields {
  uint64_t version = 0;  ///< changes since reset
  uint64_t serial = 0;   ///< changes since the simulation was made, so that no two have the same
  uint64_t height_field_serial = 0;  ///< serial of the last change of the height fields, 0 = none
  std::vector<std::vector<double>> values;  ///< by LiveFieldId; empty = as in the World's model
};

struct SnapshotData {
  std::shared_ptr<const CompiledWorld> world;
  int64_t world_since = 0;  ///< step of its run from which the simulation is in this World
  int64_t run = 0;          ///< resets before it
  int64_t step = 0;
  double time = 0;      ///< [s]
  double timestep = 0;  ///< [s]
  uint64_t hash = 0;
  std::vector<double> state;               ///< mjSTATE_INTEGRATION
  std::vector<double> sensordata;          ///< (nsensordata), of the state before the last step
  double sensor_stamp = 0;                 ///< [s]
  std::array<int, mjNWARNING> warnings{};  ///< MuJoCo's since the reset, by mjtWarning
  std::shared_ptr<const LiveFields> live;  ///< null = nothing changed
  EffectOutputs effects;
  std::vector<std::shared_ptr<const ActiveTrajectory>> trajectories;  ///< by joint, null = none
  std::vector<ActuatorOutputs> actuators;  ///< of robots with actuator models, as their layers
};

/// Whoever can hand out Snapshots in order: the live simulation, or a replay.
class SnapshotSource {
 public:
  virtual ~SnapshotSource() = default;
  /// Next Snapshot, or an empty one when the source has ended. Blocks until there is one.
  virtual Snapshot next() = 0;
};

}  // namespace gloam
