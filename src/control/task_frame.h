#pragma once
// The frame that the controllers "ik" and "osc" control, and the joints that move it.

#include "control/ik/kinematics.h"
#include "control/robot_joints.h"
#include "gloam/drive/robot_goals.h"

namespace gloam {

/// A frame of a robot, and the driven joints between it and the world.
struct TaskFrame {
  ik::FrameName name;  ///< full
  ik::FrameId frame;
  std::vector<DrivenJoint> joints;  ///< ascending by degree of freedom
  std::vector<int> dofs;            ///< of `joints`
};

/// Finds controller.task.frame of a robot. Errors: none given or no such frame, with the nearest
/// name; no driven joint moves it; two actuators on one of its joints, or one with gear 0.
Result<TaskFrame> find_task_frame(const mjModel& model, const RobotInstance& robot);

/// The frame, for goals of its pose.
Result<RobotGoals> task_frame_goals(const CompiledWorld& world, const RobotInstance& robot);

/// Pose of a frame in the world, for a goal.
Pose to_pose(const ik::Transform& X);

/// Error about a robot's controller, at its place in the scene.
Error controller_error(const RobotInstance& robot, std::string message, std::string hint = {});

}  // namespace gloam
