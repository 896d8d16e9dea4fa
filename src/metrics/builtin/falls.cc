// Falls of a floating base: it is tipped by more than 60 degrees, or at half its first height.

#include "metrics/builtin/robot_metric.h"

namespace gloam {
namespace {

class FallMetric final : public RobotMetric {
 public:
  explicit FallMetric(const MetricRobot& robot) : base_{robot.base, robot.world->serial} {}
  std::vector<MetricColumn> columns() const override { return {{"fallen", ""}}; }
  void begin_episode() override {
    has_start_ = fallen_ = false;
    falls_ = 0;
  }
  void sample(const MetricInstant& instant, std::span<double> out) override {
    constexpr double kLeastUp = 0.5, kLeastHeight = 0.5;  // cosine of 60 degrees; of the first
    const std::span<const double> q = (*instant.snapshot)[base_].qpos;
    const double up = 1 - 2 * (q[4] * q[4] + q[5] * q[5]);
    if (!has_start_) start_height_ = q[2];
    has_start_ = true;
    const bool fallen = up < kLeastUp || q[2] < kLeastHeight * start_height_;
    if (fallen && !fallen_) ++falls_;
    fallen_ = fallen;
    out[0] = fallen ? 1 : 0;
  }
  void summarize(std::vector<MetricNumber>* numbers) const override {
    numbers->emplace_back("falls", static_cast<double>(falls_));
  }

 private:
  Joint base_;
  double start_height_ = 0;  // [m]
  bool has_start_ = false, fallen_ = false;
  int64_t falls_ = 0;
};

}  // namespace

std::unique_ptr<RobotMetric> make_fall_metric(const MetricRobot& robot) {
  if (robot.base < 0) return nullptr;
  return std::make_unique<FallMetric>(robot);
}

}  // namespace gloam
