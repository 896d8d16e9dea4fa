#pragma once
// In-process controllers run on the sim thread at their declared rate, between steps.

#include <mujoco/mujoco.h>

#include "gloam/result.h"
#include "gloam/types.h"
#include "world/world.h"

namespace gloam {

struct VelocityTarget {
  double vx = 0, vy = 0, yaw_rate = 0;  ///< heading frame [m/s, m/s, rad/s]
};

/// Reads the state, writes controls. Must not allocate, lock or throw in control().
class Controller {
 public:
  virtual ~Controller() = default;
  /// The simulation stands at its initial state.
  virtual void reset(const mjModel* model, const mjData* data) = 0;
  /// Called before step `step`; writes d->ctrl of its own actuators only. `period` = time between
  /// calls [s].
  virtual void control(const mjModel* model, mjData* data, int64_t step, double period,
                       const VelocityTarget& goal) = 0;
};

}  // namespace gloam
