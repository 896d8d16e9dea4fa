#pragma once
// Controller "ik": differential inverse kinematics to a pose of one frame.

#include "gloam/controller.h"
#include "world/world.h"

namespace gloam {

/// Brings the frame of TaskSpaceOptions to the goal of SetPoseGoal; without one it keeps the pose
/// that it has at the start. Each call solves a gloam::ik problem (a frame task, a posture task,
/// limits of ranges, velocities and distances) at desired joint positions, which it integrates;
/// servos receive them as targets, motors as torques kp (q_d - q) + kd (v_d - v). Joints that do
/// not move the frame, and joints without actuators, are left alone. If the problem has no
/// solution, the desired positions stay, and the log has one warning; so it has for a goal that
/// is out of reach. Errors: those of find_task_frame.
Result<std::unique_ptr<Controller>> make_inverse_kinematics_controller(const CompiledWorld& world,
                                                                       const RobotInstance& robot);

}  // namespace gloam
