// Pose of a floating base: roll, pitch and yaw are intrinsic about x, y, z, as in ROS (REP 103).

#include <algorithm>
#include <cmath>

#include "metrics/builtin/robot_metric.h"

namespace gloam {
namespace {

class PoseMetric final : public RobotMetric {
 public:
  explicit PoseMetric(const MetricRobot& robot) : base_{robot.base, robot.world->serial} {}
  std::vector<MetricColumn> columns() const override {
    return {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"roll", "rad"}, {"pitch", "rad"}, {"yaw", "rad"}};
  }
  void begin_episode() override {}
  void sample(const MetricInstant& instant, std::span<double> out) override {
    const std::span<const double> q = (*instant.snapshot)[base_].qpos;
    const double qw = q[3], qx = q[4], qy = q[5], qz = q[6];
    std::copy_n(q.begin(), 3, out.begin());
    out[3] = std::atan2(2 * (qw * qx + qy * qz), 1 - 2 * (qx * qx + qy * qy));
    out[4] = std::asin(std::clamp(2 * (qw * qy - qz * qx), -1.0, 1.0));
    out[5] = std::atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz));
  }
  void summarize(std::vector<MetricNumber>*) const override {}

 private:
  Joint base_;
};

}  // namespace

std::unique_ptr<RobotMetric> make_pose_metric(const MetricRobot& robot) {
  if (robot.base < 0) return nullptr;
  return std::make_unique<PoseMetric>(robot);
}

}  // namespace gloam
