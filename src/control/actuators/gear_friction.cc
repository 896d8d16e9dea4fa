// Friction of gears: (F_c + (F_s − F_c) exp(−(v / v_s)²)) tanh(v / v_0) + b v, against the speed v
// of the joint: Coulomb, Stribeck and viscous friction (Olsson et al. 1998, Friction models and
// friction compensation, European Journal of Control 4, eq. 3). The sign of v is smoothed over v_0,
// so that under a constant torque below F_s the joint creeps at a speed below v_0 or so.

#include <algorithm>
#include <cmath>

#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

constexpr double kSmoothing = 0.01;  // [rad/s]

class GearFriction final : public ActuatorModel {
 public:
  struct Gear {
    size_t row;
    double sliding, extra;       // F_c, F_s − F_c [N m]
    double stribeck, smoothing;  // [rad/s]
    double viscous;              // [N m s/rad]
  };

  explicit GearFriction(std::vector<Gear> gears) : gears_(std::move(gears)) {}

  std::string_view kind() const override { return "friction"; }
  void reset(std::span<Drive>) override {}
  void take_over(const ActuatorModel&, std::span<const int>) override {}
  bool apply(ActuatorStep& step) override {
    for (const Gear& gear : gears_) {
      Drive& drive = step.drives[gear.row];
      const double v = drive.velocity, ratio = v / gear.stribeck;
      const double dry =
          gear.sliding + (gear.extra > 0 ? gear.extra * std::exp(-ratio * ratio) : 0);
      drive.torque -= dry * std::tanh(v / gear.smoothing) + gear.viscous * v;
    }
    return true;
  }
  uint64_t hash(uint64_t before) const override { return before; }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<GearFriction>(*this);
  }

 private:
  std::vector<Gear> gears_;
};

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_gear_friction(const ActuatorParts& parts) {
  std::vector<GearFriction::Gear> gears;
  for (size_t row = 0; row < parts.drives.size(); ++row) {
    const DriveSetup& drive = parts.drives[row];
    if (!drive.options.friction) continue;
    const ActuatorFriction& o = *drive.options.friction;
    const double rest = o.breakaway.value_or(o.coulomb);
    // One step of friction stops the joint at most, with its inertia in the reference pose.
    const double stable = rest * parts.timestep.value() * parts.model.dof_invweight0[drive.dof];
    gears.push_back({row, o.coulomb, rest - o.coulomb, o.stribeck_speed,
                     o.smoothing.value_or(std::max(kSmoothing, stable)), o.viscous});
  }
  if (gears.empty()) return std::unique_ptr<ActuatorModel>();
  return std::unique_ptr<ActuatorModel>(std::make_unique<GearFriction>(std::move(gears)));
}

}  // namespace gloam
