#pragma once
// Trees of bodies that are robots, as the model itself says.

#include <mujoco/mujoco.h>

#include <vector>

namespace gloam {

/// Bodies directly under the world, in order, whose tree an actuator moves. Of a model without
/// actuators (most URDFs): those with a joint that is not free.
std::vector<int> robot_roots(const mjModel& model);

}  // namespace gloam
