#pragma once
// URDF of a robot whose file is none: links, joints, inertias and shapes of the compiled model.

#include <mujoco/mujoco.h>

#include <string>

#include "world/world.h"

namespace gloam {

/// Names are those of /tf (links: bodies' full names) and of joint_states (joints). A body with
/// several joints, or one whose joint is not at its origin, gets links "BODY_JOINT" of a millionth
/// of a kilogram between. Joint positions are MuJoCo's. A ball joint is "floating", since URDF has
/// none. Shapes are boxes, spheres and cylinders; meshes and all others are the boxes around them.
/// The root is the robot's root body, or `world` where joints hang on that.
std::string robot_urdf(const mjModel& model, const RobotInstance& robot);

}  // namespace gloam
