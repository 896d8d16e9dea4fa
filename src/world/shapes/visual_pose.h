#pragma once
// Poses at qpos0, where every joint is at rest.

#include <mujoco/mujoco.h>

#include <vector>

#include "base/vec.h"
#include "world/world.h"

namespace gloam {

/// Rigid pose from MuJoCo's position and wxyz quaternion.
Affine3f rigid_pose(const mjtNum* position, const mjtNum* quaternion);

/// X_WB of every body at qpos0: the chain of body_pos and body_quat.
std::vector<Affine3f> body_poses_at_qpos0(const mjModel& model);

/// X_WB of every body where the simulation starts: at its keyframe, else at qpos0.
std::vector<Affine3f> body_poses_at_start(const CompiledWorld& world);

}  // namespace gloam
