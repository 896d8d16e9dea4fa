#include "sim/joints/joint_inputs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "world/world_robots.h"

namespace gloam {
namespace {

std::vector<Joint> single_joints(const mjModel& model, const RobotInstance& robot) {
  std::vector<Joint> joints;
  for (const int id : robot_joints(model, robot))
    if (model.jnt_type[id] == mjJNT_HINGE || model.jnt_type[id] == mjJNT_SLIDE)
      joints.push_back({id, 0});
  return joints;
}

bool moves(const ActiveTrajectory& trajectory, Joint joint) {
  return std::ranges::find(trajectory.joints, joint.id, &Joint::id) != trajectory.joints.end();
}

// Ids of `joints` in the World after; empty if one is gone.
std::vector<Joint> translated(const std::vector<Joint>& joints, const Correspondence& same) {
  std::vector<Joint> after;
  for (const Joint joint : joints) {
    const auto found = std::ranges::find(same.joint, joint.id);
    if (found == same.joint.end()) return {};
    after.push_back({static_cast<int>(found - same.joint.begin()), same.after.serial});
  }
  return after;
}

}  // namespace

std::vector<Joint> joints_of_command(const CompiledWorld& world, Robot robot,
                                     const std::vector<Joint>& named) {
  if (!named.empty()) return named;
  return single_joints(*world.model, world.robots[static_cast<size_t>(robot.id)]);
}

JointInputs::JointInputs(const CompiledWorld& world, const mjModel& model)
    : targets_(static_cast<size_t>(model.njnt)),
      robot_of_joint_(static_cast<size_t>(model.njnt), -1) {
  for (const RobotInstance& robot : world.robots) {
    RobotInputs& inputs = robots_.emplace_back();
    inputs.joints = single_joints(model, robot);
    start_.resize(std::max(start_.size(), inputs.joints.size()));
    for (const Joint joint : inputs.joints)
      robot_of_joint_[static_cast<size_t>(joint.id)] = static_cast<int>(robots_.size()) - 1;
  }
}

void JointInputs::take_over(const JointInputs& before, const Correspondence& same) {
  for (size_t joint = 0; joint < targets_.size(); ++joint)
    if (const int old = same.joint[joint]; old >= 0)
      targets_[joint] = before.targets_[static_cast<size_t>(old)];
  for (size_t robot = 0; robot < robots_.size(); ++robot) {
    const int old = same.robot[robot];
    if (old < 0 || before.trajectory(old) == nullptr) continue;
    ActiveTrajectory next = *before.trajectory(old);
    next.joints = translated(next.joints, same);
    if (next.joints.empty()) continue;
    robots_[robot].trajectory = std::make_shared<ActiveTrajectory>(std::move(next));
    robots_[robot].is_valid = true;
    robots_[robot].is_over = before.of(old).is_over;
  }
}

void JointInputs::reset() {
  std::ranges::fill(targets_, JointTarget{});
  for (RobotInputs& robot : robots_) robot.is_valid = false;
}

void JointInputs::reset(int robot) {
  of(robot).is_valid = false;
  for (const Joint joint : of(robot).joints) target(joint) = {};
}

void JointInputs::leave_trajectory(RobotInputs* robot, Joint joint) {
  if (robot->is_valid && moves(*robot->trajectory, joint)) robot->is_valid = false;
}

void JointInputs::apply(const SetJointGoal& command) {
  target(command.joint).position = command.position;
  const int robot = robot_of_joint_[static_cast<size_t>(command.joint.id)];
  if (robot >= 0) leave_trajectory(&of(robot), command.joint);
}

void JointInputs::apply(const SetJointCommand& command) {
  RobotInputs& robot = of(command.robot.id);
  const std::vector<Joint>& joints = command.joints.empty() ? robot.joints : command.joints;
  const auto set = [&](const std::vector<double>& values, double JointTarget::* field) {
    for (size_t i = 0; i < values.size(); ++i) target(joints[i]).*field = values[i];
  };
  set(command.position, &JointTarget::position);
  set(command.velocity, &JointTarget::velocity);
  set(command.effort, &JointTarget::effort);
  set(command.kp, &JointTarget::kp);
  set(command.kd, &JointTarget::kd);
  if (command.position.empty() && command.velocity.empty()) return;
  for (const Joint joint : joints) leave_trajectory(&robot, joint);
}

void JointInputs::follow(int robot, const mjModel& model, const mjData& data, int64_t step,
                         std::shared_ptr<ActiveTrajectory>* next) {
  RobotInputs& inputs = of(robot);
  ActiveTrajectory& trajectory = **next;
  const double time = data.time;
  update(robot, time);
  const bool continues = inputs.is_valid && !inputs.is_over;
  for (size_t i = 0; i < trajectory.joints.size(); ++i) {
    const Joint joint = trajectory.joints[i];
    const JointTarget& now = target(joint);
    JointSample& start = start_[i];
    start = {std::isfinite(now.position) ? now.position : data.qpos[model.jnt_qposadr[joint.id]],
             std::isfinite(now.velocity) ? now.velocity : 0};
    if (!continues) continue;
    const auto same = std::ranges::find(inputs.trajectory->joints, joint.id, &Joint::id);
    if (same != inputs.trajectory->joints.end())
      start = inputs.trajectory->at(time,
                                    static_cast<size_t>(same - inputs.trajectory->joints.begin()));
  }
  trajectory.path.begin({start_.data(), trajectory.joints.size()});
  trajectory.start_step = step;
  trajectory.start_time = time;
  std::swap(inputs.trajectory, *next);
  inputs.is_valid = true;
  inputs.is_over = false;
}

void JointInputs::stop(int robot, const mjModel& model, const mjData& data) {
  RobotInputs& inputs = of(robot);
  if (!inputs.is_valid) return;
  inputs.is_valid = false;
  if (inputs.is_over) return;  // its joints have their goals
  for (const Joint joint : inputs.trajectory->joints) {
    target(joint).position = data.qpos[model.jnt_qposadr[joint.id]];
    target(joint).velocity = JointTarget::kNone;
  }
}

void JointInputs::update(int robot, double time) {
  RobotInputs& inputs = of(robot);
  if (!inputs.is_valid || inputs.is_over) return;
  const ActiveTrajectory& trajectory = *inputs.trajectory;
  for (size_t i = 0; i < trajectory.joints.size(); ++i) {
    const JointSample sample = trajectory.at(time, i);
    target(trajectory.joints[i]).position = sample.position;
    target(trajectory.joints[i]).velocity = sample.velocity;
  }
  inputs.is_over = time >= trajectory.end_time();
}

}  // namespace gloam
