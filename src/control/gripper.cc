#include "control/gripper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "control/robot_joints.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

// Fingers pull with the full force when they are this fraction of their range from their target.
constexpr double kFullForceError = 0.05;
// Bandwidth of the damping of a finger driven by a motor [1/s].
constexpr double kDampingRate = 60;

/// A joint whose goal moves the gripper.
struct FingerJoint {
  int joint = -1;
  double closed = 0, open = 0;  // positions [m or rad]
  double last_goal = NAN;       // latest goal from a Command [m or rad]

  double opening_of(double position) const { return (position - closed) / (open - closed); }
};

/// An actuator of the gripper: of one joint, or of a tendon that moves several.
struct Finger {
  DrivenJoint terms;
  int tendon = -1;              // -1 = of the joint in `terms`
  double closed = 0, open = 0;  // length of the tendon or position of the joint [m or rad]
  double stiffness = 0;         // of a motor [N/m or N m/rad]
  double damping = 0;           // [N s/m or N m s/rad]

  double at(double opening) const { return closed + opening * (open - closed); }
  double length(const mjData& data) const {
    return tendon >= 0 ? data.ten_length[tendon] : data.qpos[terms.qpos];
  }
  double speed(const mjData& data) const {
    return tendon >= 0 ? data.ten_velocity[tendon] : data.qvel[terms.dof];
  }
};

class GripperController final : public Controller {
 public:
  GripperController(std::vector<Finger> fingers, std::vector<FingerJoint> joints,
                    const GripOptions& options)
      : fingers_(std::move(fingers)), joints_(std::move(joints)), options_(options) {}

  void reset(const mjModel*, const mjData* data) override {
    wanted_ = options_.opening;
    opening_ = mean_opening(*data);
    for (FingerJoint& joint : joints_) joint.last_goal = NAN;
  }

  void take_over(const mjModel* model, const mjData* data, const Controller& before) override {
    reset(model, data);
    const auto* old = dynamic_cast<const GripperController*>(&before);
    if (old == nullptr) return;
    wanted_ = old->wanted_;
    opening_ = old->opening_;
    if (joints_.size() != old->joints_.size()) return;
    for (size_t i = 0; i < joints_.size(); ++i) joints_[i].last_goal = old->joints_[i].last_goal;
  }

  void control(const ControlInputs& in) override {
    read_goals(in);
    const double travel = std::abs(fingers_.front().open - fingers_.front().closed);
    const double most = options_.speed * in.period / travel;
    opening_ += std::clamp(wanted_ - opening_, -most, most);
    for (const Finger& finger : fingers_) {
      const DrivenJoint& terms = finger.terms;
      in.data->ctrl[terms.ctrl] =
          terms.takes_target
              ? std::clamp(servo_control(finger, *in.data), terms.lowest, terms.highest)
              : control_of_torque(terms, motor_torque(finger, *in.data));
    }
  }

  std::unique_ptr<Controller> clone() const override {
    return std::make_unique<GripperController>(*this);
  }

 private:
  double mean_opening(const mjData& data) const {
    double sum = 0;
    for (const Finger& finger : fingers_)
      sum += (finger.length(data) - finger.closed) / (finger.open - finger.closed);
    return sum / static_cast<double>(fingers_.size());
  }

  // The latest goal that changed moves all fingers.
  void read_goals(const ControlInputs& in) {
    if (in.joint_targets.empty()) return;
    for (FingerJoint& joint : joints_) {
      const double goal = in.joint_targets[static_cast<size_t>(joint.joint)].position;
      if (!std::isfinite(goal) || goal == joint.last_goal) continue;
      joint.last_goal = goal;
      wanted_ = std::clamp(joint.opening_of(goal), 0.0, 1.0);
    }
  }

  // A servo's target stays so near its finger that its force is within the limit.
  double servo_control(const Finger& finger, const mjData& data) const {
    const double length = finger.length(data);
    const double gear = finger.terms.gear;
    const double reach = options_.force / (gear * gear * finger.terms.gain);
    return gear * (length + std::clamp(finger.at(opening_) - length, -reach, reach));
  }

  double motor_torque(const Finger& finger, const mjData& data) const {
    const double most = options_.force;
    const double spring = finger.stiffness * (finger.at(opening_) - finger.length(data));
    return std::clamp(std::clamp(spring, -most, most) - finger.damping * finger.speed(data), -most,
                      most);
  }

  std::vector<Finger> fingers_;
  std::vector<FingerJoint> joints_;
  GripOptions options_;
  double wanted_ = 1, opening_ = 1;  // 0 = closed … 1 = open
};

struct Range {
  double low = 0, high = 0;
};

std::optional<Range> range_of_joint(const mjModel& model, int joint) {
  if (!model.jnt_limited[joint]) return {};
  return Range{model.jnt_range[2 * joint], model.jnt_range[2 * joint + 1]};
}

// The limits of the tendon, else the control range of its servo.
std::optional<Range> range_of_tendon(const mjModel& model, int tendon, const DrivenJoint& terms) {
  if (model.tendon_limited[tendon])
    return Range{model.tendon_range[2 * tendon], model.tendon_range[2 * tendon + 1]};
  if (!terms.takes_target || !std::isfinite(terms.lowest + terms.highest)) return {};
  return Range{terms.lowest / terms.gear, terms.highest / terms.gear};
}

/// Collects the actuators of a robot that have a range, and the joints that they move.
class FingerFinder {
 public:
  FingerFinder(const mjModel& model, const RobotInstance& robot)
      : model_(model), options_(robot.options.controller) {
    for (DrivenJoint& joint : driven_joints(model, robot)) add_joint(std::move(joint));
    for (int actuator = 0; actuator < model.nactuator; ++actuator)
      if (may_use(robot, actuator)) add_tendon(robot, actuator);
  }

  std::vector<Finger> fingers;
  std::vector<FingerJoint> joints;

 private:
  void add_joint(DrivenJoint terms) {
    const std::optional<Range> range = range_of_joint(model_, terms.joint);
    if (!range || terms.gear == 0) return;
    const double inertia = model_.dof_M0[terms.dof];
    add_finger({std::move(terms)}, *range, inertia);
    joints.push_back(joint_of(fingers.back().terms.joint, *range, +1));
  }

  void add_tendon(const RobotInstance& robot, int actuator) {
    if (model_.actuator_trntype[actuator] != mjTRN_TENDON) return;
    const int tendon = model_.actuator_trnid[2 * actuator];
    std::optional<DrivenJoint> terms = actuator_terms(model_, actuator);
    const std::vector<int> moved = joints_of_tendon(model_, tendon);
    if (!terms || terms->gear == 0 || moved.empty() ||
        !is_part_of(model_, model_.jnt_bodyid[moved[0]], robot.root_body)) {
      return;
    }
    const std::optional<Range> range = range_of_tendon(model_, tendon, *terms);
    if (!range) return;
    const double inertia = 1 / std::max(model_.tendon_invweight0[tendon], mjMINVAL);
    add_finger({std::move(*terms), tendon}, *range, inertia);
    for (size_t i = 0; i < moved.size(); ++i) {
      const double along = model_.wrap_prm[model_.tendon_adr[tendon] + static_cast<int>(i)];
      if (const std::optional<Range> own = range_of_joint(model_, moved[i]))
        joints.push_back(joint_of(moved[i], *own, along));
    }
  }

  // `inertia`: along the finger's motion [kg or kg m²].
  void add_finger(Finger finger, const Range& range, double inertia) {
    finger.closed = options_.grip.inverted ? range.high : range.low;
    finger.open = options_.grip.inverted ? range.low : range.high;
    finger.stiffness = options_.grip.force / (kFullForceError * (range.high - range.low));
    // Explicit damping is stable below two inertias a period.
    finger.damping = inertia * std::min(kDampingRate, 0.5 * options_.rate.value());
    fingers.push_back(std::move(finger));
  }

  // `along`: change of the finger's length with the joint; its sign counts.
  FingerJoint joint_of(int joint, const Range& range, double along) const {
    const bool swap = options_.grip.inverted != (along < 0);
    return {joint, swap ? range.high : range.low, swap ? range.low : range.high};
  }

  const mjModel& model_;
  const ControllerOptions& options_;
};

}  // namespace

Result<std::unique_ptr<Controller>> make_gripper_controller(const CompiledWorld& world,
                                                            const RobotInstance& robot) {
  const ControllerOptions& options = robot.options.controller;
  FingerFinder found(*world.model, robot);
  if (found.fingers.empty()) {
    return Error{ErrorKind::kInput,
                 fmt::format("robot '{}' has no driven joint or tendon with limits, so controller "
                             "'gripper' has no fingers",
                             robot.name),
                 options.loc, "give the fingers' joints a range and an actuator"};
  }
  return std::unique_ptr<Controller>(std::make_unique<GripperController>(
      std::move(found.fingers), std::move(found.joints), options.grip));
}

Result<RobotGoals> gripper_goals(const CompiledWorld& world, const RobotInstance& robot) {
  const FingerFinder found(*world.model, robot);
  if (found.joints.empty()) return RobotGoals();
  const FingerJoint& finger = found.joints.front();
  return RobotGoals{
      .gripper = FingerGoal{
          {finger.joint}, finger.closed, finger.open, robot.options.controller.grip.opening}};
}

}  // namespace gloam
