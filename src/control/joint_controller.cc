#include "control/joint_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/log.h"
#include "control/robot_joints.h"

namespace gloam {
namespace {

enum class JointLaw : uint8_t { kPosition, kVelocity, kEffort };

constexpr const char* kLawNames[] = {"joint_position", "joint_velocity", "joint_effort"};

/// A number that a target has, else another.
double given_or(double value, double other) { return std::isfinite(value) ? value : other; }

struct Gains {
  double kp, kd;  // [N m/rad], [N m s/rad]
};

// Torques hold for a period T, so a joint of inertia J is stable up to kd T/J = 2 and 2 kd T/J +
// kp T²/J = 4. Joints of one robot accelerate each other, hence a quarter of that.
Gains stable_gains(const DrivenJoint& joint, Gains gains, double period) {
  const double kd = 0.5 * joint.inertia / period;
  return {std::min(gains.kp, 0.5 * kd / period), std::min(gains.kd, kd)};
}

class JointController final : public Controller {
 public:
  JointController(JointLaw law, std::vector<DrivenJoint> joints, const ControllerOptions& options)
      : law_(law),
        joints_(std::move(joints)),
        kp_(options.kp),
        kd_(options.kd),
        reference_(options.target),
        hold_initial_(options.target.empty()) {
    reference_.resize(joints_.size());
  }

  void reset(const mjModel*, const mjData* data) override {
    if (!hold_initial_) return;
    for (size_t i = 0; i < joints_.size(); ++i) reference_[i] = data->qpos[joints_[i].qpos];
  }

  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    reset(model, data);
    if (!hold_initial_) return;
    const auto* old = dynamic_cast<const JointController*>(&before);
    if (old == nullptr || old->law_ != law_)
      continue_torques(*data);
    else if (old->hold_initial_)
      continue_references(*old);
  }

  void control(const ControlInputs& in) override {
    mjData* const data = in.data;
    for (size_t i = 0; i < joints_.size(); ++i) {
      const DrivenJoint& joint = joints_[i];
      JointTarget target;
      if (!in.joint_targets.empty()) target = in.joint_targets[static_cast<size_t>(joint.joint)];
      data->ctrl[joint.ctrl] = std::clamp(
          control_of(joint, *data, in.period, target, &reference_[i]), joint.lowest, joint.highest);
    }
  }
  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<JointController>(*this);
  }

 private:
  // Held joints keep their goal: a held joint sags, and would sag further each time.
  void continue_references(const JointController& old) {
    for (size_t i = 0; i < joints_.size(); ++i) {
      for (size_t j = 0; j < old.joints_.size(); ++j) {
        const bool same_name = joints_[i].name == old.joints_[j].name;
        if (same_name && (i == j || !joints_[i].name.empty())) reference_[i] = old.reference_[j];
      }
    }
  }

  // Without a jump of any force: the reference is where its spring gives the present torque.
  void continue_torques(const mjData& data) {
    for (size_t i = 0; i < joints_.size(); ++i) {
      const DrivenJoint& joint = joints_[i];
      const double q = data.qpos[joint.qpos], v = data.qvel[joint.dof];
      if (joint.takes_target) {
        reference_[i] = data.ctrl[joint.ctrl] / joint.gear;
      } else if (kp_ > 0) {
        const double force = joint.gain * data.ctrl[joint.ctrl] + servo_bias(joint, data);
        reference_[i] =
            q +
            (joint.gear * std::clamp(force, joint.force_lowest, joint.force_highest) + kd_ * v) /
                kp_;
      }
    }
  }

  static double servo_bias(const DrivenJoint& joint, const mjData& data) {
    return joint.bias[0] + joint.bias[1] * joint.gear * data.qpos[joint.qpos] +
           joint.bias[2] * joint.gear * data.qvel[joint.dof];
  }

  double control_of(const DrivenJoint& joint, const mjData& data, double period,
                    const JointTarget& target, double* reference) const {
    const bool own_gains = !std::isfinite(target.kp) && !std::isfinite(target.kd);
    double q = *reference;
    if (law_ == JointLaw::kVelocity) q = *reference = integral(joint, data, period, target, q);
    q = given_or(target.position, q);
    if (law_ != JointLaw::kEffort && own_gains) {
      if (joint.takes_target) return servo_target(joint, joint.gear * q, target);
      if (joint.takes_velocity && law_ == JointLaw::kVelocity)
        return servo_target(joint, 0, target);
    }
    const Gains gains =
        stable_gains(joint, {given_or(target.kp, kp_), given_or(target.kd, kd_)}, period);
    return torque_control(joint, data, torque_of(joint, data, q, target, gains));
  }

  // Moves the reference by one period. The spring to it gives no more than the actuator can.
  double integral(const DrivenJoint& joint, const mjData& data, double period,
                  const JointTarget& target, double reference) const {
    if (std::isfinite(target.position)) return target.position;
    reference += given_or(target.velocity, 0) * period;
    const double kp = given_or(target.kp, kp_), q = data.qpos[joint.qpos];
    if (kp <= 0 || joint.takes_target) return reference;
    const double a = joint.gear * joint.force_lowest / kp,
                 b = joint.gear * joint.force_highest / kp;
    return std::clamp(reference, q + std::min(a, b), q + std::max(a, b));
  }

  // A servo's own gains act on velocity and effort, too: its control is moved by as much as gives
  // that force.
  static double servo_target(const DrivenJoint& joint, double control, const JointTarget& target) {
    if (std::isfinite(target.velocity))
      control -= joint.bias[2] / joint.gain * joint.gear * target.velocity;
    if (std::isfinite(target.effort)) control += target.effort / (joint.gear * joint.gain);
    return control;
  }

  double torque_of(const DrivenJoint& joint, const mjData& data, double q,
                   const JointTarget& target, const Gains& gains) const {
    const double v = given_or(target.velocity, 0);
    double torque = 0;
    if (law_ != JointLaw::kEffort || std::isfinite(target.position)) {
      torque = gains.kp * (q - data.qpos[joint.qpos]) - gains.kd * (data.qvel[joint.dof] - v);
    } else if (std::isfinite(target.velocity)) {
      torque = -gains.kd * (data.qvel[joint.dof] - v);
    }
    if (std::isfinite(target.effort)) torque += target.effort;
    return torque;
  }

  static double torque_control(const DrivenJoint& joint, const mjData& data, double torque) {
    const double force = std::clamp(torque / joint.gear, joint.force_lowest, joint.force_highest);
    const bool is_servo = joint.takes_target || joint.takes_velocity;
    return (is_servo ? force - servo_bias(joint, data) : force) / joint.gain;
  }

  JointLaw law_;
  std::vector<DrivenJoint> joints_;
  double kp_, kd_;                 // [N m/rad], [N m s/rad]
  std::vector<double> reference_;  // q* where there is no target [rad or m], by driven joint
  bool hold_initial_;
};

// Lower gains than the user set are reported, once per controller.
void report_lowered_gains(const std::vector<DrivenJoint>& joints, const RobotInstance& robot,
                          double period) {
  const ControllerOptions& options = robot.options.controller;
  const DrivenJoint* first = nullptr;
  int count = 0;
  for (const DrivenJoint& joint : joints) {
    const Gains gains = stable_gains(joint, {options.kp, options.kd}, period);
    if (joint.takes_target || (gains.kp == options.kp && gains.kd == options.kd)) continue;
    if (count++ == 0) first = &joint;
  }
  if (first == nullptr) return;
  const Gains gains = stable_gains(*first, {options.kp, options.kd}, period);
  log_warning(
      "controller '{}' of robot '{}': kp = {:g} and kd = {:g} at {:g} Hz are too stiff for light "
      "joints ({} of {}); '{}' gets {:.2g} and {:.2g}",
      options.type, robot.name, options.kp, options.kd, 1 / period, count, joints.size(),
      first->name, gains.kp, gains.kd);
}

Result<std::unique_ptr<Controller>> make_joint_controller(JointLaw law, const CompiledWorld& world,
                                                          const RobotInstance& robot) {
  const ControllerOptions& options = robot.options.controller;
  const char* name = kLawNames[static_cast<size_t>(law)];
  std::vector<DrivenJoint> joints = driven_joints(
      *world.model, robot,
      law == JointLaw::kPosition ? VelocityServos::kLeaveOut : VelocityServos::kInclude);
  if (joints.empty()) {
    return Error{
        ErrorKind::kInput,
        fmt::format("robot '{}' has no motor or {} on a joint, so controller '{}' has "
                    "nothing to control",
                    robot.name, law == JointLaw::kPosition ? "position servo" : "servo", name),
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
  report_lowered_gains(joints, robot, 1 / options.rate.value());
  return std::unique_ptr<Controller>(
      std::make_unique<JointController>(law, std::move(joints), options));
}

}  // namespace

Result<std::unique_ptr<Controller>> make_joint_position_controller(const CompiledWorld& world,
                                                                   const RobotInstance& robot) {
  return make_joint_controller(JointLaw::kPosition, world, robot);
}
Result<std::unique_ptr<Controller>> make_joint_velocity_controller(const CompiledWorld& world,
                                                                   const RobotInstance& robot) {
  return make_joint_controller(JointLaw::kVelocity, world, robot);
}
Result<std::unique_ptr<Controller>> make_joint_effort_controller(const CompiledWorld& world,
                                                                 const RobotInstance& robot) {
  return make_joint_controller(JointLaw::kEffort, world, robot);
}

}  // namespace gloam
