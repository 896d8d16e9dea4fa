// The torque that a control commands, by the law of the actuator in the model (motor or servo) and
// its force range.

#include <algorithm>

#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

class DriveLaw final : public ActuatorModel {
 public:
  std::string_view kind() const override { return "law"; }
  void reset(std::span<Drive>) override {}
  void take_over(const ActuatorModel&, std::span<const int>) override {}
  bool apply(ActuatorStep& step) override {
    const mjModel& m = step.model;
    for (Drive& drive : step.drives) {
      const double force = drive.gain * drive.command + drive.bias;
      const int actuator = drive.setup->actuator;
      const mjtNum* range = m.actuator_forcerange + 2 * actuator;
      const bool is_limited = m.actuator_forcelimited[actuator];
      drive.demand = force * drive.gear;
      drive.torque = (is_limited ? std::clamp(force, range[0], range[1]) : force) * drive.gear;
    }
    return true;
  }
  uint64_t hash(uint64_t before) const override { return before; }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<DriveLaw>(*this);
  }
};

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_drive_law(const ActuatorParts&) {
  return std::unique_ptr<ActuatorModel>(std::make_unique<DriveLaw>());
}

}  // namespace gloam
