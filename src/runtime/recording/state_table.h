#pragma once
// The rows of state.csv: joints, controls and poses of robots' bodies at an instant.

#include <string>
#include <vector>

#include "gloam/snapshot.h"
#include "world/world.h"

namespace gloam {

/// Columns, names as in the model, what has none by its number ("joint 3"):
///   time_s
///   JOINT.q_rad, .v_radps (hinge); .q_m, .v_mps (slide); .qw … .qz, .wx_radps … (ball);
///   .x_m … .z_m, .qw … .qz, .vx_mps …, .wx_radps … (free; linear world axes, angular the body's)
///   ACTUATOR.control    of those with several: .control_0 …
///   BODY.body.x_m, .y_m, .z_m, .qw, .qx, .qy, .qz   of robots' bodies, in the world; of a bare
///                                                   model, of all
class StateTable {
 public:
  StateTable(const CompiledWorld& world, uint64_t serial);
  const std::vector<std::string>& columns() const { return columns_; }
  /// The row of one instant, of the World that the table was made for. Error: MuJoCo's.
  Result<std::vector<double>> row(const Snapshot& snapshot);

 private:
  void add_joints(const mjModel& model);
  void add_controls(const mjModel& model);
  void add_bodies(const CompiledWorld& world);

  uint64_t serial_;
  std::vector<std::string> columns_;
  std::vector<Joint> joints_;
  std::vector<int> bodies_;
  size_t controls_ = 0;  // numbers of all actuators
  Instant instant_;
};

}  // namespace gloam
