// Length of the way of a robot that moves about: the horizontal distances from sample to sample.

#include <cmath>

#include "metrics/builtin/robot_metric.h"

namespace gloam {
namespace {

class PathMetric final : public RobotMetric {
 public:
  explicit PathMetric(const MetricRobot& robot) : root_(robot.root()) {}
  std::vector<MetricColumn> columns() const override {
    return {{"path_length", "m"}, {"speed", "m/s"}};
  }
  void begin_episode() override {
    has_last_ = false;
    length_ = 0;
  }
  void sample(const MetricInstant& instant, std::span<double> out) override {
    const mjtNum* p = instant.data->xpos + 3 * root_;
    if (has_last_) length_ += std::hypot(p[0] - last_[0], p[1] - last_[1]);
    has_last_ = true;
    last_[0] = p[0];
    last_[1] = p[1];
    const Vec3 v = velocity_of_point(instant, root_, {p[0], p[1], p[2]});
    out[0] = length_;
    out[1] = std::hypot(v.x, v.y);
  }
  void summarize(std::vector<MetricNumber>* numbers) const override {
    numbers->emplace_back("path_length_m", length_);
  }

 private:
  int root_;
  bool has_last_ = false;
  double last_[2] = {}, length_ = 0;  // [m]
};

}  // namespace

std::unique_ptr<RobotMetric> make_path_metric(const MetricRobot& robot) {
  if (!robot.moves_about) return nullptr;
  return std::make_unique<PathMetric>(robot);
}

}  // namespace gloam
