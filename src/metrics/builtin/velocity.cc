// Velocity of a floating base in its heading frame, against the goals that the scene's schedule
// sets.

#include <algorithm>
#include <cmath>

#include "metrics/builtin/robot_metric.h"

namespace gloam {
namespace {

constexpr const char* kAxes[] = {"vx", "vy", "yaw_rate"};

class VelocityMetric final : public RobotMetric {
 public:
  explicit VelocityMetric(const MetricRobot& robot)
      : base_{robot.base, robot.world->serial}, goals_(robot.instance->options.controller.goals) {}

  std::vector<MetricColumn> columns() const override {
    return {{"vx", "m/s"},      {"vy", "m/s"},      {"yaw_rate", "rad/s"},
            {"vx_goal", "m/s"}, {"vy_goal", "m/s"}, {"yaw_rate_goal", "rad/s"}};
  }
  void begin_episode() override {
    std::fill_n(error_squared_, 3, 0.0);
    std::fill_n(goal_squared_, 3, 0.0);
  }

  void sample(const MetricInstant& instant, std::span<double> out) override {
    const JointState base = (*instant.snapshot)[base_];
    const double qw = base.qpos[3], qx = base.qpos[4], qy = base.qpos[5], qz = base.qpos[6];
    const double yaw = std::atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz));
    const double c = std::cos(yaw), s = std::sin(yaw);
    // A free joint's linear velocity is in world axes, its angular velocity in the body's.
    const double wx = base.qvel[3], wy = base.qvel[4], wz = base.qvel[5];
    out[0] = c * base.qvel[0] + s * base.qvel[1];
    out[1] = -s * base.qvel[0] + c * base.qvel[1];
    out[2] = 2 * (qx * qz - qw * qy) * wx + 2 * (qy * qz + qw * qx) * wy +
             (1 - 2 * (qx * qx + qy * qy)) * wz;
    VelocityGoal current;
    for (const VelocityGoal& goal : goals_)
      if (goal.time <= instant.time()) current = goal;
    out[3] = current.vx;
    out[4] = current.vy;
    out[5] = current.yaw_rate;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double error = out[axis] - out[axis + 3];
      error_squared_[axis] += error * error;
      goal_squared_[axis] += out[axis + 3] * out[axis + 3];
    }
  }

  void summarize(std::vector<MetricNumber>* numbers) const override {
    for (size_t axis = 0; axis < 3; ++axis) {
      if (goal_squared_[axis] <= 0) continue;
      numbers->emplace_back(std::string(kAxes[axis]) + "_error_rms_percent",
                            100 * std::sqrt(error_squared_[axis] / goal_squared_[axis]));
    }
  }

 private:
  Joint base_;
  std::vector<VelocityGoal> goals_;
  double error_squared_[3] = {}, goal_squared_[3] = {};
};

}  // namespace

std::unique_ptr<RobotMetric> make_velocity_metric(const MetricRobot& robot) {
  if (robot.base < 0) return nullptr;
  return std::make_unique<VelocityMetric>(robot);
}

}  // namespace gloam
