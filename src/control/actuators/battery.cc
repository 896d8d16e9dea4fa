// A battery with an open-circuit voltage V0 over its charge and an internal resistance R. Drives
// take the power P whatever the voltage (they are switched converters), so the current I solves P =
// I (V0 − I R). It can deliver V0² / 4 R at most. The voltage limits torques of the next step.

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

constexpr double kSecondsPerHour = 3600;

double open_voltage(const BatteryOptions& options, double charge) {
  return options.curve.empty() ? options.voltage : interpolate(options.curve, charge);
}

class Battery final : public ActuatorModel {
 public:
  explicit Battery(const BatteryOptions& options)
      : options_(options), nominal_(nominal_voltage(options)) {}

  std::string_view kind() const override { return "battery"; }
  void reset(std::span<Drive> drives) override {
    charge_ = options_.charge;
    current_ = 0;
    voltage_ = charge_ > 0 ? open_voltage(options_, charge_) : 0;
    supply(drives);
  }
  void take_over(const ActuatorModel& before, std::span<const int>) override {
    const auto& old = static_cast<const Battery&>(before);
    charge_ = old.charge_;
    current_ = old.current_;
    voltage_ = old.voltage_;
  }
  bool apply(ActuatorStep& step) override {
    if (charge_ > 0 || step.power < 0) {
      const double open = open_voltage(options_, charge_), r = options_.internal_resistance;
      const double root = std::max(0.0, open * open - 4 * r * step.power);
      // The smaller solution, in a form without cancellation.
      current_ = r > 0 && root == 0 ? open / (2 * r) : 2 * step.power / (open + std::sqrt(root));
      voltage_ = open - current_ * r;
      const double drawn = current_ * step.timestep / (kSecondsPerHour * options_.capacity);
      charge_ = std::clamp(charge_ - drawn, 0.0, 1.0);
    } else {
      current_ = voltage_ = 0;
    }
    supply(step.drives);
    return true;
  }
  uint64_t hash(uint64_t before) const override {
    const double memory[] = {charge_, current_, voltage_};
    return hash_span<double>(memory, before);
  }
  void publish(ActuatorOutputs* out) const override {
    out->voltage = voltage_;
    out->current = current_;
    out->charge = charge_;
    out->capacity = options_.capacity;
  }
  std::unique_ptr<ActuatorModel> clone() const override { return std::make_unique<Battery>(*this); }

 private:
  void supply(std::span<Drive> drives) const {
    for (Drive& drive : drives) drive.supply = voltage_ / nominal_;
  }

  BatteryOptions options_;
  double nominal_;                                 // [V]
  double charge_ = 0, current_ = 0, voltage_ = 0;  // 0 … 1, [A], [V]
};

}  // namespace

double nominal_voltage(const BatteryOptions& battery) {
  return battery.nominal_voltage.value_or(open_voltage(battery, battery.charge));
}

Result<std::unique_ptr<ActuatorModel>> make_battery(const ActuatorParts& parts) {
  if (!parts.robot.actuators || !parts.robot.actuators->battery)
    return std::unique_ptr<ActuatorModel>();
  return std::unique_ptr<ActuatorModel>(std::make_unique<Battery>(*parts.robot.actuators->battery));
}

}  // namespace gloam
