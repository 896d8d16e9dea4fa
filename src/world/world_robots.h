#pragma once
// Trees of bodies that are robots, as the model itself says.

#include <mujoco/mujoco.h>

#include <vector>

#include "world/world.h"

namespace gloam {

/// Bodies directly under the world, in order, whose tree an actuator moves. Of a model without
/// actuators (most URDFs): those with a joint that is not free.
std::vector<int> robot_roots(const mjModel& model);

/// True if `body` is `root` or hangs on it.
bool is_part_of(const mjModel& model, int body, int root);

/// The free joint that carries `body` (its own or that of the floating base it hangs from), or -1.
int floating_joint(const mjModel& model, int body);

/// Joints and actuators of a robot, in the model's order. An actuator is its robot's whose tree it
/// drives, or whose name it has.
std::vector<int> robot_joints(const mjModel& model, const RobotInstance& robot);
std::vector<int> robot_actuators(const mjModel& model, const RobotInstance& robot);

}  // namespace gloam
