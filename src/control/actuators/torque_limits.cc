// Largest torques at the speed, supply voltage and temperature of the motor.
//
// A DC motor whose terminals have at most the voltage ±V gives torques between the lines
// stall (±s − w / w0), with the speed w, the no-load speed w0 and the supply s = V / V_nominal: the
// four-quadrant limit of Isaac Lab's DCMotor (isaaclab.actuators). Beyond s w0 it can only brake.
// A table has the torques of driving motors; braking ones have that of rest.

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct TorqueRange {
  double low = -kInfinity, high = kInfinity;  // [N m]
};

TorqueRange range_of_table(const ActuatorOptions& o, double speed, double supply) {
  const double driving = supply * interpolate(o.curve, std::abs(speed) / supply);
  const double braking = supply * o.curve[0][1];
  return speed >= 0 ? TorqueRange{-braking, driving} : TorqueRange{-driving, braking};
}

// At the motor.
TorqueRange range_of(const Drive& drive) {
  const ActuatorOptions& o = drive.options();
  if (drive.supply <= 0) return {0, 0};  // switched off: the motor turns freely
  const double speed = drive.motor_speed();
  TorqueRange range;
  double rest = kInfinity;  // the largest torque at rest
  if (!o.curve.empty()) {
    range = range_of_table(o, speed, drive.supply);
    rest = drive.supply * o.curve[0][1];
  } else if (o.stall_torque > 0) {
    const double back = speed / o.no_load_speed;
    range = {o.stall_torque * (-drive.supply - back), o.stall_torque * (drive.supply - back)};
    rest = drive.supply * o.stall_torque;
  }
  double limit = o.torque_limit > 0 ? o.torque_limit / o.gear_ratio : kInfinity;
  if (drive.derating < 1) limit = drive.derating * std::min(limit, rest);
  return {std::clamp(range.low, -limit, limit), std::clamp(range.high, -limit, limit)};
}

class TorqueLimits final : public ActuatorModel {
 public:
  std::string_view kind() const override { return "limits"; }
  void reset(std::span<Drive>) override {}
  void take_over(const ActuatorModel&, std::span<const int>) override {}
  bool apply(ActuatorStep& step) override {
    for (Drive& drive : step.drives) {
      if (drive.is_propeller()) continue;  // its speed controller has limits of its own
      const TorqueRange range = range_of(drive);
      const double ratio = drive.options().gear_ratio;
      drive.torque = std::clamp(drive.torque, ratio * range.low, ratio * range.high);
    }
    return true;
  }
  uint64_t hash(uint64_t before) const override { return before; }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<TorqueLimits>(*this);
  }
};

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_torque_limits(const ActuatorParts&) {
  return std::unique_ptr<ActuatorModel>(std::make_unique<TorqueLimits>());
}

}  // namespace gloam
