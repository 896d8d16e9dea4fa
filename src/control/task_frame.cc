#include "control/task_frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "world/world_robots.h"

namespace gloam {

Error controller_error(const RobotInstance& robot, std::string message, std::string hint) {
  return Error{ErrorKind::kInput,
               fmt::format("controller '{}' of robot '{}': {}", robot.options.controller.type,
                           robot.name, message),
               robot.options.controller.loc, std::move(hint)};
}

Pose to_pose(const ik::Transform& X) {
  const Eigen::Quaterniond q(X.R);
  return {{X.p.x(), X.p.y(), X.p.z()}, {q.w(), q.x(), q.y(), q.z()}};
}

Result<TaskFrame> find_task_frame(const mjModel& model, const RobotInstance& robot) {
  const std::string& text = robot.options.controller.task.frame;
  if (text.empty())
    return controller_error(robot, "it needs the frame that it controls",
                            "set frame = \"site NAME\", \"body NAME\" or \"geom NAME\"");
  Result<ik::FrameName> name = ik::parse_frame(text);
  if (!name.ok()) return controller_error(robot, name.error().message, name.error().hint);
  name->name = robot.prefix + name->name;
  const Result<ik::FrameId> frame = ik::find_frame(model, *name);
  if (!frame.ok()) return controller_error(robot, frame.error().message, frame.error().hint);
  TaskFrame found{*name, *frame, {}, {}};
  const int body = frame->body(model);
  if (!is_part_of(model, body, robot.root_body))
    return controller_error(robot, fmt::format("'{}' is not a part of the robot", text));
  for (const DrivenJoint& joint : driven_joints(model, robot))
    if (is_part_of(model, body, model.jnt_bodyid[joint.joint])) found.joints.push_back(joint);
  std::ranges::sort(found.joints, {}, &DrivenJoint::dof);
  if (found.joints.empty())
    return controller_error(robot, fmt::format("no motor or position servo moves '{}'", text),
                            "choose a frame that is moved by driven hinges or slides");
  for (const DrivenJoint& joint : found.joints) {
    if (joint.gear == 0)
      return controller_error(robot,
                              fmt::format("the actuator of joint '{}' has gear 0", joint.name));
    if (!found.dofs.empty() && found.dofs.back() == joint.dof)
      return controller_error(robot, fmt::format("two actuators drive joint '{}'", joint.name));
    found.dofs.push_back(joint.dof);
  }
  return found;
}

Result<RobotGoals> task_frame_goals(const CompiledWorld& world, const RobotInstance& robot) {
  GLOAM_TRY(TaskFrame task, find_task_frame(*world.model, robot));
  return RobotGoals{.frame = std::move(task.name)};
}

}  // namespace gloam
