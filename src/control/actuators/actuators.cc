#include "control/actuators/actuators.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "control/actuators/actuator_model.h"

namespace gloam {
namespace {

constexpr double kCelsius = 273.15;      // 0 °C [K]
constexpr double kRoomTemperature = 20;  // [°C]
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double air_temperature(const CompiledWorld& world) {
  return world.gases.gases.empty() ? kRoomTemperature
                                   : double{world.gases.gases[0].temperature} - kCelsius;
}

// Speed of a propeller through the air along its thrust [m/s]. After a step mjData has the
// velocities of its beginning, so that a propeller meets the air one step late.
double inflow_of(const DriveSetup& propeller, const mjModel& model, const mjData& data) {
  mjtNum twist[6], axis[3];  // world axes: angular, linear
  mj_objectVelocity(&model, &data, mjOBJ_SITE, propeller.site, twist, 0);
  mju_mulMatVec3(axis, data.site_xmat + 9 * propeller.site,
                 model.actuator_gear + 6 * propeller.output);
  mju_normalize3(axis);
  return mju_dot3(twist + 3, axis) - mju_dot3(model.opt.wind, axis);
}

/// Constant data, shared by clones.
struct RobotSetup {
  RobotOptions options;
  std::vector<DriveSetup> drives;
  double air_temperature;  // [°C]
  ActuatorNetworkLoader load_network;
};

class RobotActuators final : public ActuatorLayer {
 public:
  explicit RobotActuators(std::shared_ptr<const RobotSetup> setup) : setup_(std::move(setup)) {
    for (const DriveSetup& drive : setup_->drives) drives_.push_back({.setup = &drive});
  }
  RobotActuators(const RobotActuators& other)
      : setup_(other.setup_),
        drives_(other.drives_),
        timestep_(other.timestep_),
        power_(other.power_),
        error_(other.error_) {
    for (const auto& model : other.models_) models_.push_back(model->clone());
  }

  Status begin(const mjModel& model, Rational timestep) override {
    timestep_ = timestep.value();
    GLOAM_TRY(models_, make_actuator_models({setup_->options, setup_->drives, model, timestep,
                                             setup_->air_temperature, setup_->load_network}));
    return {};
  }

  void reset(const mjModel& model, const mjData& data) override {
    for (Drive& drive : drives_) drive = {.setup = drive.setup};
    power_ = 0;
    read(model, data);
    for (const auto& one : models_) one->reset(drives_);
  }

  void take_over(const mjModel& model, const mjData& data, const ActuatorLayer& before) override {
    reset(model, data);
    const auto* old = dynamic_cast<const RobotActuators*>(&before);
    if (old == nullptr) return;
    std::vector<int> old_row(drives_.size(), -1);
    for (size_t i = 0; i < drives_.size(); ++i) {
      for (size_t j = 0; j < old->drives_.size(); ++j)
        if (old->drives_[j].setup->name == drives_[i].setup->name) old_row[i] = static_cast<int>(j);
      if (old_row[i] < 0) continue;
      const DriveSetup* const setup = drives_[i].setup;
      drives_[i] = old->drives_[static_cast<size_t>(old_row[i])];
      drives_[i].setup = setup;
    }
    for (const auto& one : models_)
      for (const auto& from : old->models_)
        if (from->kind() == one->kind()) one->take_over(*from, old_row);
  }

  bool apply(const mjModel& model, mjData& data) override {
    read(model, data);
    ActuatorStep step{model, drives_, timestep_};
    for (const auto& one : models_) {
      if (one->apply(step)) continue;
      error_ = std::move(step.error);
      return false;
    }
    power_ = step.power;
    for (Drive& drive : drives_) {
      drive.force = drive.torque / drive.gear;
      data.ctrl[drive.setup->ctrl] = (drive.force - drive.bias) / drive.gain;
    }
    return true;
  }

  void observe(const mjModel& model, const mjData& data) override {
    for (Drive& drive : drives_)
      if (drive.is_propeller()) drive.inflow = inflow_of(*drive.setup, model, data);
  }

  Error error() const override { return error_; }

  uint64_t hash(uint64_t before) const override {
    for (const auto& one : models_) before = one->hash(before);
    for (const Drive& drive : drives_)
      if (drive.is_propeller()) before = hash_bytes(&drive.inflow, sizeof(drive.inflow), before);
    return before;
  }

  void publish(ActuatorOutputs* out) const override {
    out->voltage = out->current = out->charge = out->capacity = out->energy = kNaN;
    out->power = power_;
    out->drives.resize(drives_.size());
    for (size_t i = 0; i < drives_.size(); ++i) {
      const Drive& drive = drives_[i];
      const bool has_current = drive.options().torque_constant > 0;
      out->drives[i] = {drive.setup->actuator, drive.force, has_current ? drive.current : kNaN,
                        drive.temperature, drive.motor_speed()};
    }
    for (const auto& one : models_) one->publish(out);
  }

  std::unique_ptr<ActuatorLayer> clone() const override {
    return std::make_unique<RobotActuators>(*this);
  }

 private:
  void read(const mjModel& model, const mjData& data) {
    for (Drive& drive : drives_) {
      const DriveSetup& setup = *drive.setup;
      const mjtNum* gear = model.actuator_gear + 6 * setup.output;
      drive.command = data.ctrl[setup.ctrl];
      drive.gear = drive.is_propeller() ? mju_norm3(gear) : gear[0];
      if (!drive.is_propeller()) {
        drive.position = data.qpos[setup.qpos];
        drive.velocity = data.qvel[setup.dof];
      }
      const ActuatorLaw law = actuator_law(model, data, setup.actuator);
      drive.gain = law.gain;
      drive.bias = law.bias;
    }
  }

  std::shared_ptr<const RobotSetup> setup_;
  std::vector<Drive> drives_;
  std::vector<std::unique_ptr<ActuatorModel>> models_;
  double timestep_ = 0;  // [s]
  double power_ = 0;     // of the last step [W]
  Error error_;
};

}  // namespace

Result<std::unique_ptr<ActuatorLayer>> make_actuators(const CompiledWorld& world,
                                                      const RobotInstance& robot,
                                                      ActuatorNetworkLoader load_network) {
  if (robot.options.actuator.empty()) return std::unique_ptr<ActuatorLayer>();
  GLOAM_TRY(std::vector<DriveSetup> drives, find_drives(*world.model, robot));
  auto setup = std::make_shared<const RobotSetup>(RobotSetup{
      robot.options, std::move(drives), air_temperature(world), std::move(load_network)});
  return std::unique_ptr<ActuatorLayer>(std::make_unique<RobotActuators>(std::move(setup)));
}

}  // namespace gloam
