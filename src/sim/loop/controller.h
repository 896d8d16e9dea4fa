#pragma once
// In-process controllers run on the sim thread at their declared rate, between steps.

#include <mujoco/mujoco.h>

#include <span>

#include "gloam/result.h"
#include "gloam/types.h"
#include "sim/effects/soil/soil_reaction.h"
#include "world/world.h"

namespace gloam {

struct VelocityTarget {
  double vx = 0, vy = 0, yaw_rate = 0;  ///< heading frame [m/s, m/s, rad/s]
};

/// Reads the state, writes controls. Must not allocate, lock or throw in control().
class Controller {
 public:
  virtual ~Controller() = default;
  /// Begins anew: the simulation stands at its initial state, or a recompile brought the robot.
  virtual void reset(const mjModel* model, const mjData* data) = 0;
  /// Goes on from `before`, the same robot's controller in the World before a recompile: what it
  /// remembers of the robot counts, what it knows of the model is its own. Where that cannot be,
  /// it begins anew from where the simulation stands.
  virtual void take_over(const mjModel* model, const mjData* data, const Controller& before) {
    static_cast<void>(before);
    reset(model, data);
  }
  /// Called before step `step`; writes d->ctrl of its own actuators only. `soil`: what carries or
  /// holds things in soft ground, of the last step as data's contacts are. `period` = time between
  /// calls [s].
  virtual void control(const mjModel* model, mjData* data, std::span<const SoilReaction> soil,
                       int64_t step, double period, const VelocityTarget& goal) = 0;
};

}  // namespace gloam
