#include "gloam/drive/robot_goals.h"

#include <fmt/format.h>

#include "control/controllers.h"
#include "control/parted_controller.h"
#include "control/task_frame.h"

namespace gloam {
Result<RobotGoals> robot_goals(const World& world, Robot robot) {
  const CompiledWorld& compiled = *world.compiled();
  if (robot.id < 0 || static_cast<size_t>(robot.id) >= compiled.robots.size())
    return Error{ErrorKind::kUsage, fmt::format("there is no robot number {}", robot.id)};
  const RobotInstance& whole = compiled.robots[static_cast<size_t>(robot.id)];
  RobotGoals goals;
  GLOAM_TRY(const auto parts, robot_parts(*compiled.model, whole));
  for (const ControlledPart& part : parts) {
    GLOAM_TRY(RobotGoals own, controller_goals(compiled, part.robot));
    if (!goals.velocity) goals.velocity = own.velocity;
    if (!goals.frame) goals.frame = std::move(own.frame);
    if (!goals.gripper) goals.gripper = own.gripper;
  }
  if (goals.gripper) goals.gripper->joint.world = robot.world;
  return goals;
}

Result<Pose> frame_pose(const Instant& instant, const ik::FrameName& frame) {
  GLOAM_TRY(const ik::FrameId id, ik::find_frame(*instant.model(), frame));
  return to_pose(ik::pose_of(*instant.data(), id));
}

}  // namespace gloam
