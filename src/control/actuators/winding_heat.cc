// Temperature T of windings: C dT/dt = i² R − (T − T_air) / R_th, solved exactly for the loss of
// each step. The torque limit falls linearly from derate_start to zero at cutoff.

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

class WindingHeat final : public ActuatorModel {
 public:
  struct Winding {
    size_t row;
    double air;              // [°C]
    double resistance;       // to the air [K/W]
    double share;            // of the way to the final temperature that one step goes
    double start, cutoff;    // [°C]
    double temperature = 0;  // [°C]
  };

  explicit WindingHeat(std::vector<Winding> windings) : windings_(std::move(windings)) {}

  std::string_view kind() const override { return "thermal"; }
  void reset(std::span<Drive> drives) override {
    for (Winding& winding : windings_) {
      winding.temperature = winding.air;
      show(winding, drives[winding.row]);
    }
  }
  void take_over(const ActuatorModel& before, std::span<const int> old_row) override {
    for (Winding& winding : windings_)
      for (const Winding& from : static_cast<const WindingHeat&>(before).windings_)
        if (static_cast<int>(from.row) == old_row[winding.row])
          winding.temperature = from.temperature;
  }
  bool apply(ActuatorStep& step) override {
    for (Winding& winding : windings_) {
      Drive& drive = step.drives[winding.row];
      const double final = winding.air + drive.loss * winding.resistance;
      winding.temperature += winding.share * (final - winding.temperature);
      show(winding, drive);
    }
    return true;
  }
  uint64_t hash(uint64_t before) const override {
    for (const Winding& winding : windings_)
      before = hash_bytes(&winding.temperature, sizeof(winding.temperature), before);
    return before;
  }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<WindingHeat>(*this);
  }

 private:
  static void show(const Winding& winding, Drive& drive) {
    const double left = (winding.cutoff - winding.temperature) / (winding.cutoff - winding.start);
    drive.derating = std::clamp(left, 0.0, 1.0);
    drive.temperature = winding.temperature;
  }

  std::vector<Winding> windings_;
};

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_winding_heat(const ActuatorParts& parts) {
  std::vector<WindingHeat::Winding> windings;
  for (size_t row = 0; row < parts.drives.size(); ++row) {
    const std::optional<MotorThermal>& o = parts.drives[row].options.thermal;
    if (!o) continue;
    const double time_constant = o->thermal_resistance * o->heat_capacity;  // [s]
    windings.push_back({row, o->ambient.value_or(parts.air_temperature), o->thermal_resistance,
                        -std::expm1(-parts.timestep.value() / time_constant), o->derate_start,
                        o->cutoff});
  }
  if (windings.empty()) return std::unique_ptr<ActuatorModel>();
  return std::unique_ptr<ActuatorModel>(std::make_unique<WindingHeat>(std::move(windings)));
}

}  // namespace gloam
