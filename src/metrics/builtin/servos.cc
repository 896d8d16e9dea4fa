// Tracking errors of joints: target less position of position servos (a gain and a bias of equal
// size), hinges [rad] and slides [m] apart. A servo's control is its target, within its range.

#include <algorithm>
#include <cmath>

#include "metrics/builtin/robot_metric.h"

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

struct ServoGroup {
  std::vector<int> actuators;
  const char* unit = "rad";
  double square = 0, most = 0;  // sum over all samples; largest absolute error
  int64_t count = 0;
};

class ServoMetric final : public RobotMetric {
 public:
  explicit ServoMetric(const MetricRobot& robot) {
    for (const auto& [type, unit] : {std::pair(mjJNT_HINGE, "rad"), std::pair(mjJNT_SLIDE, "m")}) {
      ServoGroup group;
      group.unit = unit;
      for (const int actuator : robot.actuators)
        if (is_servo(*robot.world->model, actuator, type)) group.actuators.push_back(actuator);
      if (!group.actuators.empty()) groups_.push_back(group);
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
        const double error = target - instant.data->actuator_length[m.actuator_outadr[a]];
        square += error * error;
        group.most = std::max(group.most, std::fabs(error));
      }
      group.square += square;
      group.count += static_cast<int64_t>(group.actuators.size());
      out[g] = std::sqrt(square / static_cast<double>(group.actuators.size()));
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
