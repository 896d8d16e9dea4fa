// Tracking errors of joints, hinges [rad] and slides [m] apart: target less position of position
// servos (a gain and a bias of equal size), whose control is the target, within its range; and of
// motors under a joint_position controller, whose targets are those of the scene. Goals that
// Commands give to such a motor are in no Snapshot and not seen.

#include <algorithm>
#include <cmath>

#include "control/robot_joints.h"
#include "metrics/builtin/robot_metric.h"
#include "sim/state/initial_state.h"
#include "world/model_memory.h"

namespace gloam {
namespace {

// Is the actuator a position servo of a joint of that type?
bool is_servo(const mjModel& m, int actuator, int joint_type) {
  const mjtNum gain = m.actuator_gainprm[mjNGAIN * actuator];
  return m.actuator_trntype[actuator] == mjTRN_JOINT && m.actuator_ctrlnum[actuator] == 1 &&
         m.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         m.actuator_biastype[actuator] == mjBIAS_AFFINE && gain > 0 &&
         m.actuator_biasprm[mjNBIAS * actuator + 1] == -gain &&
         m.jnt_type[m.actuator_trnid[2 * actuator]] == joint_type;
}

/// A joint that a controller holds with a motor.
struct HeldJoint {
  int qpos = 0;
  double target = 0;  // [rad or m]
};

// Motors of a joint_position controller, on joints of that type.
std::vector<HeldJoint> held_joints(const MetricRobot& robot, int joint_type) {
  const mjModel& m = *robot.world->model;
  const ControllerOptions& options = robot.instance->options.controller;
  if (options.type != "joint_position") return {};
  const std::vector<DrivenJoint> joints = driven_joints(m, *robot.instance);
  const DataPtr data = make_data(m);
  reset_to_initial_state(*robot.world, m, *data);
  std::vector<HeldJoint> held;
  for (size_t i = 0; i < joints.size(); ++i) {
    const DrivenJoint& joint = joints[i];
    if (joint.takes_target || m.jnt_type[joint.joint] != joint_type) continue;
    const bool is_given = i < options.target.size();
    held.push_back({joint.qpos, is_given ? options.target[i] : data->qpos[joint.qpos]});
  }
  return held;
}

struct ServoGroup {
  std::vector<int> actuators;
  std::vector<HeldJoint> held;
  const char* unit = "rad";
  double square = 0, most = 0;  // sum over all samples; largest absolute error
  int64_t count = 0;

  size_t joints() const { return actuators.size() + held.size(); }
  void add(double error, double* sum) {
    *sum += error * error;
    most = std::max(most, std::fabs(error));
  }
};

class ServoMetric final : public RobotMetric {
 public:
  explicit ServoMetric(const MetricRobot& robot) {
    for (const auto& [type, unit] : {std::pair(mjJNT_HINGE, "rad"), std::pair(mjJNT_SLIDE, "m")}) {
      ServoGroup group;
      group.unit = unit;
      for (const int actuator : robot.actuators)
        if (is_servo(*robot.world->model, actuator, type)) group.actuators.push_back(actuator);
      group.held = held_joints(robot, type);
      if (group.joints() > 0) groups_.push_back(group);
    }
  }
  bool is_empty() const { return groups_.empty(); }

  std::vector<MetricColumn> columns() const override {
    std::vector<MetricColumn> columns;
    for (const ServoGroup& group : groups_) columns.push_back({name(group), group.unit});
    return columns;
  }
  void begin_episode() override {
    for (ServoGroup& group : groups_) {
      group.square = group.most = 0;
      group.count = 0;
    }
  }
  /// The root mean square over the joints.
  void sample(const MetricInstant& instant, std::span<double> out) override {
    const mjModel& m = *instant.model;
    for (size_t g = 0; g < groups_.size(); ++g) {
      ServoGroup& group = groups_[g];
      double square = 0;
      for (const int a : group.actuators) {
        const int c = m.actuator_ctrladr[a];
        mjtNum target = instant.data->ctrl[c];
        if (m.actuator_ctrllimited[c])
          target = std::clamp(target, m.actuator_ctrlrange[2 * c], m.actuator_ctrlrange[2 * c + 1]);
        group.add(target - instant.data->actuator_length[m.actuator_outadr[a]], &square);
      }
      for (const HeldJoint& joint : group.held)
        group.add(joint.target - instant.data->qpos[joint.qpos], &square);
      group.square += square;
      group.count += static_cast<int64_t>(group.joints());
      out[g] = std::sqrt(square / static_cast<double>(group.joints()));
    }
  }
  void summarize(std::vector<MetricNumber>* numbers) const override {
    for (const ServoGroup& group : groups_) {
      if (group.count == 0) continue;
      numbers->emplace_back(with_unit(name(group) + "_rms", group.unit),
                            std::sqrt(group.square / static_cast<double>(group.count)));
      numbers->emplace_back(with_unit(name(group) + "_max", group.unit), group.most);
    }
  }

 private:
  static std::string name(const ServoGroup& group) {
    return group.unit == std::string("rad") ? "joint_error" : "slide_error";
  }
  std::vector<ServoGroup> groups_;
};

}  // namespace

std::unique_ptr<RobotMetric> make_servo_metric(const MetricRobot& robot) {
  auto metric = std::make_unique<ServoMetric>(robot);
  if (metric->is_empty()) return nullptr;
  return metric;
}

}  // namespace gloam
