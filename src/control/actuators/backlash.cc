// Play of a gear: a dead zone of width b between the motor and the joint (angles seen at the
// joint).
//
// While the teeth are in contact, the rotor moves with the joint; its inertia J is the armature of
// the joint in the model. The force of the teeth is τ − J a with the joint's acceleration a of the
// last step; where it would pull, the teeth part. In the play the rotor turns freely under the
// torque of the motor, and nothing reaches the joint. At the other side it meets the joint without
// bouncing: the momentum J (w − v) of the rotor goes over in one step. The model adds J to the
// inertia of the joint in the play, too.

#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

class Backlash final : public ActuatorModel {
 public:
  struct Gear {
    size_t row;
    double half;        // of the play [rad]
    double lead = 0;    // of the motor before the joint, -half … half [rad]
    double speed = 0;   // of the rotor [rad/s]
    double before = 0;  // speed of the joint at the step before [rad/s]
    double is_loose = 1;
    double has_hit = 0;  // the step before was an impact, whose acceleration says nothing
  };

  explicit Backlash(std::vector<Gear> gears) : gears_(std::move(gears)) {}

  std::string_view kind() const override { return "backlash"; }
  // In the middle of the play.
  void reset(std::span<Drive> drives) override {
    for (Gear& gear : gears_) {
      Drive& drive = drives[gear.row];
      gear.lead = 0;
      gear.is_loose = 1;
      gear.has_hit = 0;
      gear.speed = gear.before = drive.velocity;
      show(gear, drive);
    }
  }
  void take_over(const ActuatorModel& before, std::span<const int> old_row) override {
    for (Gear& gear : gears_) {
      for (const Gear& from : static_cast<const Backlash&>(before).gears_) {
        if (static_cast<int>(from.row) != old_row[gear.row]) continue;
        const double half = gear.half;
        const size_t row = gear.row;
        gear = from;
        gear.row = row;
        gear.half = half;
        gear.lead = std::clamp(gear.lead, -half, half);
      }
    }
  }
  bool apply(ActuatorStep& step) override {
    for (Gear& gear : gears_) {
      Drive& drive = step.drives[gear.row];
      const double inertia = step.model.dof_armature[drive.setup->dof];
      turn(gear, drive, inertia, step.timestep);
      gear.before = drive.velocity;
      show(gear, drive);
    }
    return true;
  }
  uint64_t hash(uint64_t before) const override {
    for (const Gear& gear : gears_) {
      const double memory[] = {gear.lead, gear.speed, gear.before, gear.is_loose, gear.has_hit};
      before = hash_span<double>(memory, before);
    }
    return before;
  }
  std::unique_ptr<ActuatorModel> clone() const override {
    return std::make_unique<Backlash>(*this);
  }

 private:
  static void show(const Gear& gear, Drive& drive) {
    drive.is_loose = gear.is_loose != 0;
    drive.loose_speed = gear.speed;
  }
  static void turn(Gear& gear, Drive& drive, double inertia, double timestep) {
    if (gear.is_loose == 0) {
      const double acceleration = gear.has_hit != 0 ? 0 : (drive.velocity - gear.before) / timestep;
      gear.has_hit = 0;
      const double teeth = drive.torque - inertia * acceleration;
      gear.speed = drive.velocity;
      if (teeth * gear.lead >= 0) return;
      gear.is_loose = 1;
    }
    gear.speed += timestep * drive.torque / inertia;
    gear.lead += timestep * (gear.speed - drive.velocity);
    drive.torque = 0;
    if (gear.lead > -gear.half && gear.lead < gear.half) return;
    gear.lead = std::clamp(gear.lead, -gear.half, gear.half);
    drive.torque = inertia * (gear.speed - drive.velocity) / timestep;
    gear.speed = drive.velocity;
    gear.is_loose = 0;
    gear.has_hit = 1;
  }

  std::vector<Gear> gears_;
};

}  // namespace

Result<std::unique_ptr<ActuatorModel>> make_backlash(const ActuatorParts& parts) {
  std::vector<Backlash::Gear> gears;
  for (size_t row = 0; row < parts.drives.size(); ++row) {
    const DriveSetup& drive = parts.drives[row];
    if (drive.options.backlash == 0) continue;
    if (!(parts.model.dof_armature[drive.dof] > 0))
      return Error{
          ErrorKind::kInput,
          fmt::format("joint '{}' of robot '{}' has backlash, but its motor has no inertia",
                      drive.name, parts.robot.name),
          drive.options.loc,
          fmt::format("set [override.{}.joint.\"{}\"] armature, the rotor's inertia times "
                      "the square of the gear ratio",
                      parts.robot.name, drive.name)};
    gears.push_back({row, drive.options.backlash / 2});
  }
  if (gears.empty()) return std::unique_ptr<ActuatorModel>();
  return std::unique_ptr<ActuatorModel>(std::make_unique<Backlash>(std::move(gears)));
}

}  // namespace gloam
