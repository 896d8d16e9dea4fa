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

/// The trajectories of a World before, with the ids of their joints in the one after.
class TranslatedTrajectories {
 public:
  explicit TranslatedTrajectories(const Correspondence& same) : same_(same) {}

  /// Null: one of its joints is gone.
  std::shared_ptr<ActiveTrajectory> operator()(
      const std::shared_ptr<ActiveTrajectory>& trajectory) {
    for (const auto& [before, after] : made_)
      if (before == trajectory.get()) return after;
    auto after = std::make_shared<ActiveTrajectory>(*trajectory);
    for (Joint& joint : after->joints) {
      const auto found = std::ranges::find(same_.joint, joint.id);
      if (found == same_.joint.end()) {
        after = nullptr;
        break;
      }
      joint = {static_cast<int>(found - same_.joint.begin()), same_.after.serial};
    }
    return made_.emplace_back(trajectory.get(), after).second;
  }

 private:
  const Correspondence& same_;
  std::vector<std::pair<const ActiveTrajectory*, std::shared_ptr<ActiveTrajectory>>> made_;
};

}  // namespace

std::vector<Joint> joints_of_command(const CompiledWorld& world, Robot robot,
                                     const std::vector<Joint>& named) {
  if (!named.empty()) return named;
  return single_joints(*world.model, world.robots[static_cast<size_t>(robot.id)]);
}

JointInputs::JointInputs(const CompiledWorld& world, const mjModel& model)
    : targets_(static_cast<size_t>(model.njnt)), followed_(static_cast<size_t>(model.njnt)) {
  for (const RobotInstance& robot : world.robots) {
    joints_.push_back(single_joints(model, robot));
    start_.resize(std::max(start_.size(), joints_.back().size()));
  }
}

void JointInputs::take_over(const JointInputs& before, const Correspondence& same) {
  for (size_t joint = 0; joint < targets_.size(); ++joint)
    if (const int old = same.joint[joint]; old >= 0)
      targets_[joint] = before.targets_[static_cast<size_t>(old)];
  TranslatedTrajectories translated(same);
  for (const std::vector<Joint>& joints : joints_) {
    for (const Joint joint : joints) {
      const int old = same.joint[static_cast<size_t>(joint.id)];
      if (old < 0 || !before.followed_[static_cast<size_t>(old)].is_valid) continue;
      Followed& next = followed(joint) = before.followed_[static_cast<size_t>(old)];
      next.trajectory = translated(next.trajectory);
      if (next.trajectory == nullptr) leave_trajectory(joint);
    }
  }
}

void JointInputs::reset() {
  std::ranges::fill(targets_, JointTarget{});
  for (Followed& followed : followed_) followed.is_valid = false;
}

void JointInputs::reset(int robot) {
  for (const Joint joint : joints(robot)) {
    followed(joint).is_valid = false;
    target(joint) = {};
  }
}

// The position target stays. The velocity target is the trajectory's and would pull the joint
// indefinitely.
void JointInputs::leave_trajectory(Joint joint) {
  if (!followed(joint).is_valid) return;
  followed(joint).is_valid = false;
  target(joint).velocity = JointTarget::kNone;
}

void JointInputs::apply(const SetJointGoal& command) {
  leave_trajectory(command.joint);
  target(command.joint).position = command.position;
}

void JointInputs::apply(const SetJointCommand& command) {
  const std::vector<Joint>& all =
      command.joints.empty() ? joints(command.robot.id) : command.joints;
  if (!command.position.empty() || !command.velocity.empty())
    for (const Joint joint : all) leave_trajectory(joint);
  const auto set = [&](const std::vector<double>& values, double JointTarget::* field) {
    for (size_t i = 0; i < values.size(); ++i) target(all[i]).*field = values[i];
  };
  set(command.position, &JointTarget::position);
  set(command.velocity, &JointTarget::velocity);
  set(command.effort, &JointTarget::effort);
  set(command.kp, &JointTarget::kp);
  set(command.kd, &JointTarget::kd);
}

JointSample JointInputs::start_of(Joint joint, const mjModel& model, const mjData& data) {
  if (followed(joint).is_moving()) return followed(joint).at(data.time);
  const JointTarget& now = target(joint);
  return {std::isfinite(now.position) ? now.position : data.qpos[model.jnt_qposadr[joint.id]],
          std::isfinite(now.velocity) ? now.velocity : 0};
}

void JointInputs::follow(int robot, const mjModel& model, const mjData& data, int64_t step,
                         NextTrajectory* next) {
  update(robot, data.time);
  ActiveTrajectory& trajectory = *next->trajectory;
  const size_t count = trajectory.joints.size();
  for (size_t i = 0; i < count; ++i) start_[i] = start_of(trajectory.joints[i], model, data);
  trajectory.path.begin({start_.data(), count});
  trajectory.start_step = step;
  trajectory.start_time = data.time;
  for (size_t i = 0; i < count; ++i) {
    Followed& joint = followed(trajectory.joints[i]);
    std::swap(joint.trajectory, next->replaced[i]);
    joint = {next->trajectory, i, true, false};
  }
}

void JointInputs::stop(const StopTrajectory& command, const mjModel& model, const mjData& data) {
  for (const Joint joint : command.joints.empty() ? joints(command.robot.id) : command.joints) {
    const bool was_moving = followed(joint).is_moving();  // else it has its goal
    leave_trajectory(joint);
    if (was_moving) target(joint).position = data.qpos[model.jnt_qposadr[joint.id]];
  }
}

void JointInputs::update(int robot, double time) {
  for (const Joint joint : joints(robot)) {
    Followed& now = followed(joint);
    if (!now.is_moving()) continue;
    const JointSample sample = now.at(time);
    target(joint).position = sample.position;
    target(joint).velocity = sample.velocity;
    now.is_over = time >= now.trajectory->end_time();
  }
}

}  // namespace gloam
