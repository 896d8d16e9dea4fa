// Mechanical energy that actuators spend: the integral of |force · velocity| of each of their
// outputs. Braking counts as work, as of motors that feed nothing back. By the trapezoidal rule
// over the samples: of second order in their distance.
//
// Cost of transport: energy / (mass · gravity · way), after Gabrielli and von Kármán 1950 (What
// price speed?) and Tucker 1975 (The energetic cost of moving about).

#include <cmath>

#include "metrics/builtin/robot_metric.h"

namespace gloam {
namespace {

class EnergyMetric final : public RobotMetric {
 public:
  explicit EnergyMetric(const MetricRobot& robot)
      : actuators_(robot.actuators),
        root_(robot.root()),
        mass_(robot.mass),
        moves_about_(robot.moves_about) {}
  std::vector<MetricColumn> columns() const override { return {{"power", "W"}, {"energy", "J"}}; }
  void begin_episode() override {
    has_last_ = false;
    energy_ = way_ = peak_ = 0;
  }
  void sample(const MetricInstant& instant, std::span<double> out) override {
    const mjModel& m = *instant.model;
    double power = 0;
    for (const int actuator : actuators_) {
      const int first = m.actuator_outadr[actuator];
      for (int i = first; i < first + m.actuator_outnum[actuator]; ++i)
        power += std::fabs(instant.data->actuator_force[i] * instant.data->actuator_velocity[i]);
    }
    const mjtNum* p = instant.data->xpos + 3 * root_;
    if (has_last_) {
      energy_ += 0.5 * (last_power_ + power) * instant.elapsed;
      way_ += std::hypot(p[0] - last_[0], p[1] - last_[1]);
    }
    has_last_ = true;
    last_[0] = p[0];
    last_[1] = p[1];
    last_power_ = power;
    peak_ = std::fmax(peak_, power);
    gravity_ = std::hypot(m.opt.gravity[0], m.opt.gravity[1], m.opt.gravity[2]);
    out[0] = power;
    out[1] = energy_;
  }
  void summarize(std::vector<MetricNumber>* numbers) const override {
    constexpr double kMinDistance = 0.01;  // a way that a cost is told of [m]
    numbers->emplace_back("energy_J", energy_);
    numbers->emplace_back("power_max_W", peak_);
    const double weight = mass_ * gravity_;
    if (moves_about_ && way_ > kMinDistance && weight > 0)
      numbers->emplace_back("cost_of_transport", energy_ / (weight * way_));
  }

 private:
  std::vector<int> actuators_;
  int root_;
  double mass_;  // [kg]
  bool moves_about_, has_last_ = false;
  double last_[2] = {}, last_power_ = 0, gravity_ = 0;  // [m], [W], [m/s²]
  double energy_ = 0, way_ = 0, peak_ = 0;              // [J], [m], [W]
};

}  // namespace

std::unique_ptr<RobotMetric> make_energy_metric(const MetricRobot& robot) {
  if (robot.actuators.empty()) return nullptr;
  return std::make_unique<EnergyMetric>(robot);
}

}  // namespace gloam
