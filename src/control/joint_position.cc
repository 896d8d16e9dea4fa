#include "control/joint_position.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "control/robot_joints.h"

namespace gloam {
namespace {

class JointPositionController final : public Controller {
 public:
  JointPositionController(std::vector<DrivenJoint> joints, const ControllerOptions& options)
      : joints_(std::move(joints)),
        kp_(options.kp),
        kd_(options.kd),
        target_(options.target),
        hold_initial_(options.target.empty()) {
    target_.resize(joints_.size());
  }

  void reset(const mjModel*, const mjData* data) override {
    if (!hold_initial_) return;
    for (size_t i = 0; i < joints_.size(); ++i) target_[i] = data->qpos[joints_[i].qpos];
  }

  // Held joints keep their goal: a held joint sags, and would sag further each time.
  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    reset(model, data);
    const auto* old = dynamic_cast<const JointPositionController*>(&before);
    if (old == nullptr || !hold_initial_ || !old->hold_initial_) return;
    for (size_t i = 0; i < joints_.size(); ++i) {
      for (size_t j = 0; j < old->joints_.size(); ++j) {
        const bool same_name = joints_[i].name == old->joints_[j].name;
        if (same_name && (i == j || !joints_[i].name.empty())) target_[i] = old->target_[j];
      }
    }
  }

  void control(const ControlInputs& in) override {
    mjData* const data = in.data;
    for (size_t i = 0; i < joints_.size(); ++i) {
      const DrivenJoint& joint = joints_[i];
      const double target = goal_of(in, joint).value_or(target_[i]);
      data->ctrl[joint.ctrl] =
          std::clamp(joint.takes_target ? joint.gear * target : motor_control(joint, *data, target),
                     joint.lowest, joint.highest);
    }
  }
  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<JointPositionController>(*this);
  }

 private:
  static std::optional<double> goal_of(const ControlInputs& in, const DrivenJoint& joint) {
    if (in.joint_goals.empty()) return {};
    const double goal = in.joint_goals[static_cast<size_t>(joint.joint)];
    return std::isfinite(goal) ? std::optional(goal) : std::nullopt;
  }
  double motor_control(const DrivenJoint& joint, const mjData& data, double target) const {
    const double torque = kp_ * (target - data.qpos[joint.qpos]) - kd_ * data.qvel[joint.dof];
    const double force = std::clamp(torque / joint.gear, joint.force_lowest, joint.force_highest);
    return force / joint.gain;
  }

  std::vector<DrivenJoint> joints_;
  double kp_, kd_;              // [N m/rad], [N m s/rad]
  std::vector<double> target_;  // [rad or m], by driven joint
  bool hold_initial_;
};

}  // namespace

Result<std::unique_ptr<Controller>> make_joint_position_controller(const CompiledWorld& world,
                                                                   const RobotInstance& robot) {
  const ControllerOptions& options = robot.options.controller;
  std::vector<DrivenJoint> joints = driven_joints(*world.model, robot);
  if (joints.empty()) {
    return Error{ErrorKind::kInput,
                 fmt::format("robot '{}' has no motor or position servo on a joint, so controller "
                             "'joint_position' has nothing to control",
                             robot.name),
                 options.loc, "add actuators to its model"};
  }
  if (std::any_of(joints.begin(), joints.end(), [](const DrivenJoint& j) { return j.gear == 0; })) {
    return Error{
        ErrorKind::kInput,
        fmt::format("an actuator of robot '{}' has gear 0 and cannot hold its joint", robot.name),
        options.loc};
  }
  if (!options.target.empty() && options.target.size() != joints.size()) {
    return Error{ErrorKind::kInput,
                 fmt::format("'target' has {} values, but {} joints of robot '{}' are driven",
                             options.target.size(), joints.size(), robot.name),
                 options.loc, "set one angle per actuator, in the model's order"};
  }
  if (!(options.kp >= 0 && options.kd >= 0 && std::isfinite(options.kp + options.kd))) {
    return Error{ErrorKind::kInput, "'kp' and 'kd' must be finite and not negative", options.loc};
  }
  return std::unique_ptr<Controller>(
      std::make_unique<JointPositionController>(std::move(joints), options));
}

}  // namespace gloam
