#pragma once
// ActuatorModel: one physical effect in the actuators of a robot (delay, torque limits, friction
// …). model_list.cc lists them in the order in which they act.

#include <memory>
#include <span>
#include <string_view>

#include "control/actuators/actuator_network.h"
#include "control/actuators/drive.h"
#include "sim/snapshots/actuator_outputs.h"

namespace gloam {

/// A step, for all drives of a robot.
struct ActuatorStep {
  const mjModel& model;
  std::span<Drive> drives;
  double timestep;   ///< [s]
  double power = 0;  ///< electrical, of all drives [W]
  Error error = {};  ///< why apply() returned false
};

/// All calls come on the simulation's thread; apply() must not allocate, lock or throw.
class ActuatorModel {
 public:
  virtual ~ActuatorModel() = default;
  virtual std::string_view kind() const = 0;
  /// `drives` have the positions, velocities and commands of the present instant.
  virtual void reset(std::span<Drive> drives) = 0;
  /// Goes on from the same kind of model before a recompile. `old_row[i]`: row of drive i then, -1
  /// = none. reset() has been called.
  virtual void take_over(const ActuatorModel& before, std::span<const int> old_row) = 0;
  /// False: it failed, see step.error.
  virtual bool apply(ActuatorStep& step) = 0;
  /// Hash of its memory, chained from `before`.
  virtual uint64_t hash(uint64_t before) const = 0;
  virtual void publish(ActuatorOutputs*) const {}
  virtual std::unique_ptr<ActuatorModel> clone() const = 0;
};

/// Parts that models are made of.
struct ActuatorParts {
  const RobotOptions& robot;
  std::span<const DriveSetup> drives;
  const mjModel& model;
  Rational timestep;       ///< [s]
  double air_temperature;  ///< [°C]
  const ActuatorNetworkLoader& load_network;
};

/// Null: none of the drives has the effect.
using ActuatorModelMaker = Result<std::unique_ptr<ActuatorModel>> (*)(const ActuatorParts&);

/// Number of steps of a time; error: it is not a multiple of the timestep. `what`: "'delay' of …".
Result<int64_t> whole_steps(double seconds, Rational timestep, const std::string& what,
                            const SourceLoc& loc);

/// Interpolates rows (x, y) with rising x; outside of their range, returns the y of the nearest
/// row.
double interpolate(std::span<const std::array<double, 2>> rows, double x);

/// Voltage of the battery for which the values of motors hold [V].
double nominal_voltage(const BatteryOptions& battery);

// model_list.cc: in the order in which they act.
Result<std::vector<std::unique_ptr<ActuatorModel>>> make_actuator_models(const ActuatorParts&);

Result<std::unique_ptr<ActuatorModel>> make_control_delay(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_drive_law(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_torque_network(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_torque_limits(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_propellers(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_electric_power(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_winding_heat(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_battery(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_backlash(const ActuatorParts& parts);
Result<std::unique_ptr<ActuatorModel>> make_gear_friction(const ActuatorParts& parts);

}  // namespace gloam
