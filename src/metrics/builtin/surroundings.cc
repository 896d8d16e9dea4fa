// Visibility and illuminance around a floating base.

#include <algorithm>
#include <cmath>

#include "metrics/builtin/robot_metric.h"
#include "world/media/medium_description.h"

namespace gloam {
namespace {

// The least at eight points around the robot at the height of its base, since its own body keeps
// smoke out.
class VisibilityMetric final : public RobotMetric {
 public:
  explicit VisibilityMetric(const MetricRobot& robot)
      : base_{robot.base, robot.world->serial}, reach_(robot.reach), probe_(robot.probes) {}
  std::vector<MetricColumn> columns() const override { return {{"visibility", "m"}}; }
  void begin_episode() override {
    extinction_ = 0;
    samples_ = 0;
  }
  void sample(const MetricInstant& instant, std::span<double> out) override {
    constexpr int kPoints = 8;
    constexpr double kMargin = 0.15;  // for voxels that it fills in part [m]
    const std::span<const double> q = (*instant.snapshot)[base_].qpos;
    const double r = reach_ + kMargin;
    double least = 0;
    for (int i = 0; i < kPoints; ++i) {
      const double a = 2 * M_PI * i / kPoints;
      const Vec3f p{float(q[0] + r * std::cos(a)), float(q[1] + r * std::sin(a)), float(q[2])};
      const double visibility = probe_->visibility(instant.snapshot->data(), p);
      least = i == 0 ? visibility : std::min(least, visibility);
    }
    out[0] = least;
    least_ = samples_ == 0 ? least : std::min(least_, least);
    extinction_ += kKoschmieder / least;
    ++samples_;
  }
  /// The mean is that of the mean extinction.
  void summarize(std::vector<MetricNumber>* numbers) const override {
    if (samples_ == 0) return;
    numbers->emplace_back("visibility_min_m", least_);
    numbers->emplace_back("visibility_mean_m",
                          kKoschmieder * static_cast<double>(samples_) / extinction_);
  }

 private:
  Joint base_;
  double reach_;  // [m]
  const MetricProbes* probe_;
  double least_ = 0, extinction_ = 0;  // [m]; sum over the samples [1/m]
  int64_t samples_ = 0;
};

// Illuminance of a level surface over the robot, which the samples in between repeat.
class IlluminanceMetric final : public RobotMetric {
 public:
  explicit IlluminanceMetric(const MetricRobot& robot)
      : row_(static_cast<size_t>(robot.index)), every_(robot.probes->light_every) {}
  std::vector<MetricColumn> columns() const override { return {{"illuminance", "lx"}}; }
  void begin_episode() override {
    sum_ = 0;
    samples_ = 0;
  }
  void sample(const MetricInstant& instant, std::span<double> out) override {
    const double light = instant.light[row_];
    out[0] = light;
    if (samples_++ % every_ != 0) return;
    least_ = samples_ == 1 ? light : std::min(least_, light);
    sum_ += light;
  }
  void summarize(std::vector<MetricNumber>* numbers) const override {
    if (samples_ == 0) return;
    numbers->emplace_back("illuminance_min_lx", least_);
    const int64_t measured = (samples_ + every_ - 1) / every_;
    numbers->emplace_back("illuminance_mean_lx", sum_ / static_cast<double>(measured));
  }

 private:
  size_t row_;
  int64_t every_, samples_ = 0;
  double least_ = 0, sum_ = 0;  // [lx]
};

}  // namespace

std::unique_ptr<RobotMetric> make_visibility_metric(const MetricRobot& robot) {
  if (robot.base < 0 || robot.probes->visibility == nullptr) return nullptr;
  return std::make_unique<VisibilityMetric>(robot);
}

std::unique_ptr<RobotMetric> make_illuminance_metric(const MetricRobot& robot) {
  if (robot.base < 0 || robot.probes->illuminance == nullptr) return nullptr;
  return std::make_unique<IlluminanceMetric>(robot);
}

}  // namespace gloam
