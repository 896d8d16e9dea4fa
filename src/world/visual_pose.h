#pragma once
// Poses at qpos0, where every joint is at rest.

#include <mujoco/mujoco.h>

#include <vector>

#include "base/vec.h"

namespace gloam {

/// Rigid pose from MuJoCo's position and wxyz quaternion.
Affine3f rigid_pose(const mjtNum* position, const mjtNum* quaternion);

/// X_WB of every body at qpos0: the chain of body_pos and body_quat.
std::vector<Affine3f> body_poses_at_qpos0(const mjModel& model);

}  // namespace gloam
