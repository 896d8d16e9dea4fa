// Currents, losses and electrical power of motors: i = τ / k_t, P = τ ω + i² R, and the energy
// since the reset. Without a torque constant the electrical power is the mechanical one.

#include <algorithm>

#include "base/hash.h"
#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

class ElectricPower final : public ActuatorModel {
 public:
  ElectricPower(double idle, bool regenerates) : idle_(idle), regenerates_(regenerates) {}

  std::string_view kind() const override { return "power"; }
  void reset(std::span<Drive>) override { energy_ = 0; }
  void take_over(const ActuatorModel& before, std::span<const int>) override {
    energy_ = static_cast<const ElectricPower&>(before).energy_;
  }
  bool apply(ActuatorStep& step) override {
    double power = 0;
    for (Drive& drive : step.drives) {
      const ActuatorOptions& o = drive.options();
      const double torque = drive.motor_torque();
      drive.current = o.torque_constant > 0 ? torque / o.torque_constant : 0;
      drive.loss = drive.current * drive.current * o.winding_resistance;
      power += torque * drive.motor_speed() + drive.loss;
    }
    // Motors share one bus: what one of them feeds back, another takes.
    step.power = idle_ + (regenerates_ ? power : std::max(power, 0.0));
    energy_ += step.power * step.timestep;
    return true;
  }
  uint64_t hash(uint64_t before) const override {
    return hash_bytes(&energy_, sizeof(energy_), before);
  }
  void publish(ActuatorOutputs* out) const override { out->energy = energy_; }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<ElectricPower>(*this);
  }

 private:
  double idle_;  // [W]
  bool regenerates_;
  double energy_ = 0;  // [J]
};

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_electric_power(const ActuatorParts& parts) {
  const SharedActuatorOptions shared = parts.robot.actuators.value_or(SharedActuatorOptions{});
  const bool regenerates = shared.battery && shared.battery->regenerates;
  return std::unique_ptr<ActuatorModel>(
      std::make_unique<ElectricPower>(shared.idle_power, regenerates));
}

}  // namespace gloam
