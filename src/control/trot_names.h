#pragma once
// Legs and feet that [robot.joints] names, in place of those that trot_legs.h finds by the robot's
// shape.

#include <mujoco/mujoco.h>

#include <array>
#include <optional>

#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

/// A foot by its name: a geom, a site (its origin is the foot's centre, its first size the radius)
/// or a body with geoms of its own. -1 = it is none of that kind.
struct NamedFoot {
  int geom = -1, site = -1, body = -1;
  int carrier = 0;  ///< body that it is on
};

/// In the order front left, front right, rear left, rear right.
struct NamedLegs {
  std::optional<std::array<std::array<int, 3>, 4>> joints = {};  ///< hip, thigh, calf
  std::optional<std::array<NamedFoot, 4>> feet = {};
};

/// Errors: a name that the robot does not have, with the nearest one; some of the four legs, or
/// feet, only; not three hinges below each other.
Result<NamedLegs> named_legs(const mjModel& model, const RobotInstance& robot);

}  // namespace gloam
