// Slip: speed at which the points of a robot that carry load slide over what they stand on, the
// mean weighted by their normal forces. A wheel or foot that rolls or stands has none.

#include <algorithm>
#include <cmath>

#include "metrics/builtin/robot_contact.h"

namespace gloam {
namespace {

class SlipMetric final : public RobotMetric {
 public:
  explicit SlipMetric(const MetricRobot& robot) : robot_(robot) {}
  std::vector<MetricColumn> columns() const override { return {{"slip", "m/s"}}; }
  void begin_episode() override {
    way_ = last_ = 0;
    sum_ = most_ = 0;
    loaded_ = 0;
  }
  void sample(const MetricInstant& instant, std::span<double> out) override {
    double weighted = 0, load = 0;
    for (const ContactState& contact : instant.contacts) {
      const auto touch = contact_of(robot_, *instant.model, contact);
      if (!touch || touch->normal_force <= 0) continue;
      const Vec3 a = velocity_of_point(instant, touch->own_body, contact.position);
      const Vec3 b = velocity_of_point(instant, touch->other_body, contact.position);
      const Vec3 v{a.x - b.x, a.y - b.y, a.z - b.z}, &n = contact.normal;
      const double along = v.x * n.x + v.y * n.y + v.z * n.z;
      weighted +=
          touch->normal_force * std::hypot(v.x - along * n.x, v.y - along * n.y, v.z - along * n.z);
      load += touch->normal_force;
    }
    const double slip = load > 0 ? weighted / load : 0;
    way_ += 0.5 * (last_ + slip) * instant.elapsed;
    last_ = slip;
    if (load > 0) {
      sum_ += slip;
      ++loaded_;
    }
    most_ = std::max(most_, slip);
    out[0] = slip;
  }
  void summarize(std::vector<MetricNumber>* numbers) const override {
    if (loaded_ == 0) return;
    numbers->emplace_back("slip_mean_mps", sum_ / static_cast<double>(loaded_));
    numbers->emplace_back("slip_max_mps", most_);
    numbers->emplace_back("slip_length_m", way_);
  }

 private:
  MetricRobot robot_;
  double way_ = 0, last_ = 0, sum_ = 0, most_ = 0;  // [m], [m/s] …
  int64_t loaded_ = 0;                              // samples with load
};

}  // namespace

std::unique_ptr<RobotMetric> make_slip_metric(const MetricRobot& robot) {
  if (!robot.moves_about) return nullptr;
  return std::make_unique<SlipMetric>(robot);
}

}  // namespace gloam
