// Electrical power and energy of robots with actuator models ([[robot.actuator]]), their battery
// and the hottest winding. The electrical cost of transport has the losses of motors and the idle
// power in it: energy / (mass · gravity · way).

#include <cmath>
#include <limits>

#include "metrics/builtin/robot_metric.h"

namespace gloam {
namespace {

class ElectricityMetric final : public RobotMetric {
 public:
  explicit ElectricityMetric(const MetricRobot& robot)
      : robot_(robot.index),
        root_(robot.root()),
        mass_(robot.mass),
        moves_about_(robot.moves_about) {}

  std::vector<MetricColumn> columns() const override {
    return {{"electrical_power", "W"}, {"electrical_energy", "J"}};
  }
  void begin_episode() override {
    has_last_ = false;
    energy_ = way_ = 0;
    lowest_ = std::numeric_limits<double>::infinity();
    hottest_ = -lowest_;
  }
  void sample(const MetricInstant& instant, std::span<double> out) override {
    out[0] = out[1] = std::numeric_limits<double>::quiet_NaN();
    const ActuatorOutputs* own = instant.snapshot->actuators(Robot{robot_});
    if (own == nullptr) return;  // a replay whose motion is known, but not its actuators
    const mjtNum* p = instant.data->xpos + 3 * root_;
    if (has_last_) way_ += std::hypot(p[0] - last_[0], p[1] - last_[1]);
    if (!has_last_) first_energy_ = own->energy;
    has_last_ = true;
    last_[0] = p[0];
    last_[1] = p[1];
    energy_ = own->energy - first_energy_;
    charge_ = own->charge;
    lowest_ = std::fmin(lowest_, own->voltage);
    for (const DriveOutput& drive : own->drives) hottest_ = std::fmax(hottest_, drive.temperature);
    const mjtNum* gravity = instant.model->opt.gravity;
    weight_ = mass_ * std::hypot(gravity[0], gravity[1], gravity[2]);
    out[0] = own->power;
    out[1] = energy_;
  }
  void summarize(std::vector<MetricNumber>* numbers) const override {
    constexpr double kMinDistance = 0.01;  // a way that a cost is told of [m]
    if (!has_last_) return;
    numbers->emplace_back("electrical_energy_J", energy_);
    if (moves_about_ && way_ > kMinDistance && weight_ > 0)
      numbers->emplace_back("electrical_cost_of_transport", energy_ / (weight_ * way_));
    if (std::isfinite(charge_)) numbers->emplace_back("battery_charge", charge_);
    if (std::isfinite(lowest_)) numbers->emplace_back("battery_voltage_min_V", lowest_);
    if (std::isfinite(hottest_)) numbers->emplace_back("motor_temperature_max_degC", hottest_);
  }

 private:
  int robot_, root_;
  double mass_;  // [kg]
  bool moves_about_, has_last_ = false;
  double last_[2] = {}, first_energy_ = 0, weight_ = 0;  // [m], [J], [N]
  double energy_ = 0, way_ = 0;                          // [J], [m]
  double charge_ = 0, lowest_ = 0, hottest_ = 0;         // 0 … 1, [V], [°C]
};

}  // namespace

std::unique_ptr<RobotMetric> make_electricity_metric(const MetricRobot& robot) {
  if (robot.instance->options.actuator.empty()) return nullptr;
  return std::make_unique<ElectricityMetric>(robot);
}

}  // namespace gloam
