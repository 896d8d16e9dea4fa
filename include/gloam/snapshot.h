#pragma once
// Snapshot: one instant of a simulation, immutable. Live runs and replays are both SnapshotSources.

#include <cstdint>
#include <memory>
#include <span>

#include "gloam/types.h"
#include "gloam/world.h"

namespace gloam {

struct SnapshotData;  // src/sim/snapshot.h

/// Reads of one joint in one Snapshot. The spans live as long as the Snapshot.
struct JointState {
  std::span<const double>
      qpos;  ///< 1 (hinge [rad], slide [m]), 4 (ball, wxyz) or 7 (free: xyz, wxyz)
  std::span<const double> qvel;  ///< 1, 3 or 6 [rad/s, m/s]
  double position() const { return qpos[0]; }
  double velocity() const { return qvel[0]; }
};

/// Values of one MuJoCo sensor and the time of the state they were computed from.
struct SensorState {
  std::span<const double> values;
  double stamp =
      0;  ///< [s] one timestep before Snapshot::time after a step, see ARCHITECTURE.md "Poses"
};

class Snapshot {
 public:
  Snapshot() = default;
  explicit Snapshot(std::shared_ptr<const SnapshotData> data) : data_(std::move(data)) {}
  explicit operator bool() const { return data_ != nullptr; }

  int64_t step() const;                   ///< steps since reset
  double time() const;                    ///< simulation time [s]
  uint64_t hash() const;                  ///< state hash chained over all steps since reset
  std::span<const double> state() const;  ///< mjSTATE_INTEGRATION, in mj_getState's order

  JointState operator[](Joint joint) const;
  SensorState operator[](SensorHandle sensor) const;
  double control(Actuator actuator) const;  ///< the first of several

  World world() const;  ///< of which this is an instant: after a recompile another one

  const SnapshotData& data() const { return *data_; }

 private:
  std::shared_ptr<const SnapshotData> data_;
};

}  // namespace gloam
