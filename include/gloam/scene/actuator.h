#pragma once
// Actuators between the controls of a robot and MuJoCo ([robot.actuators], [[robot.actuator]]):
// motor, propeller, battery, gear and network models. Part of gloam/scene.h. Equations:
// docs/actuators.md.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// friction of a [[robot.actuator]]: friction of the gear, at the joint.
struct ActuatorFriction {
  double coulomb = 0;                    ///< sliding friction [N m]
  std::optional<double> breakaway = {};  ///< friction at rest, >= coulomb [N m]; none = coulomb
  double stribeck_speed = 0.1;           ///< speed over which breakaway falls to coulomb [rad/s]
  double viscous = 0;                    ///< [N m s/rad]
  /// Speed below which friction falls to zero [rad/s]; none = 0.01, or the lowest stable speed.
  std::optional<double> smoothing = {};
};

/// thermal of a [[robot.actuator]]: temperature of the winding, a first-order model.
struct MotorThermal {
  double thermal_resistance = 1;  ///< winding to air [K/W]
  double heat_capacity = 100;     ///< of the winding [J/K]
  double derate_start = 80;       ///< temperature from which the torque limit falls [°C]
  double cutoff = 100;            ///< temperature at which the torque limit is zero [°C]
  /// Air temperature [°C]; none = the temperature of the first [[gas]], otherwise 20.
  std::optional<double> ambient = {};
};

/// network of a [[robot.actuator]]: a learned map from histories of position error and velocity to
/// torque (Hwangbo et al. 2019, Science Robotics 4, eaau5872).
struct ActuatorNetworkOptions {
  std::filesystem::path file = {};  ///< ONNX, relative to the scene file
  double period = 0.005;            ///< between evaluations, and between samples of histories [s]
  int history = 3;                  ///< samples of each history, the newest first
  /// Order of the inputs of one joint: position_velocity | velocity_position
  std::string order = "position_velocity";
  double position_scale = 1;  ///< of target − position [rad]; -1 for Walk-These-Ways
  double velocity_scale = 1;  ///< of the joint's velocity [rad/s]
  double torque_scale = 1;    ///< of the output [N m]
  /// Motors: gains of the controller, from whose torque the target is computed [N m/rad], [N m
  /// s/rad]. Position servos have their own.
  std::optional<double> kp = {};
  double kd = 0;
};

/// propeller of a [[robot.actuator]]: a propeller with fixed pitch on the shaft of the motor. The
/// control of its actuator commands the thrust that the propeller has at rest; a speed controller
/// turns the motor at the speed of that thrust. Advance ratio: J = v / (n D), with the speed v
/// through the air along the thrust and n turns per second (McCormick 1995, "Aerodynamics,
/// Aeronautics, and Flight Mechanics", chapter 6).
struct PropellerOptions {
  double diameter = 0;            ///< D [m]
  double thrust_coefficient = 0;  ///< C_T at J = 0: thrust = C_T ρ n² D⁴
  /// C_P at J = 0: power of the shaft = C_P ρ n³ D⁵; none = from the reaction torque in the
  /// actuator's gear.
  std::optional<double> power_coefficient = {};
  /// J at which the thrust, and the torque, is zero, both linear in J; none = constant.
  std::optional<double> zero_thrust_advance = {}, zero_torque_advance = {};
  double inertia = 0;  ///< of propeller and rotor about the shaft [kg m²]
  double response_time =
      0.02;                    ///< time constant of the speed while voltage and current suffice [s]
  double no_load_current = 0;  ///< that friction and iron losses of the motor take [A]
  double current_limit = 0;    ///< of the speed controller [A]; 0 = not limited
  double voltage = 0;          ///< of the supply of a robot without battery [V]
  double air_density = 1.225;  ///< ρ [kg/m³]
};

/// [[robot.actuator]]: the actuators of some joints, or the propellers, of a robot. If several
/// tables match a joint or propeller, the last applies.
struct ActuatorOptions {
  /// Names of joints in the robot's own model: a regular expression (RE2) that matches whole names.
  std::string joints = ".*";
  /// Instead: names of actuators that push at sites, with `propeller`.
  std::string actuators = {};
  double gear_ratio = 1;     ///< motor speed per joint speed
  double stall_torque = 0;   ///< DC motor: torque at rest, at the motor [N m]; 0 = not limited
  double no_load_speed = 0;  ///< DC motor: speed at which no torque is left, at the motor [rad/s]
  /// Instead of both: speed and largest driving torque, at the motor [rad/s, N m].
  std::vector<std::array<double, 2>> curve = {};
  double torque_limit = 0;        ///< at the joint [N m]; 0 = not limited
  double torque_constant = 0;     ///< of the motor [N m/A]; 0 = currents are not computed
  double winding_resistance = 0;  ///< of the motor [ohm]
  double delay = 0;               ///< of controls, a multiple of the timestep [s]
  double backlash = 0;            ///< total play between motor and joint, at the joint [rad]
  std::optional<ActuatorFriction> friction = {};
  std::optional<MotorThermal> thermal = {};
  std::optional<ActuatorNetworkOptions> network = {};
  std::optional<PropellerOptions> propeller = {};
  SourceLoc loc = {};
};

/// battery of [robot.actuators]: supplies all actuators of the robot.
struct BatteryOptions {
  double voltage = 0;  ///< open-circuit voltage [V]
  /// Instead: charge (0 … 1) and open-circuit voltage [V].
  std::vector<std::array<double, 2>> curve = {};
  /// Voltage for which stall_torque, no_load_speed and curve of actuators hold [V]; none = the
  /// open-circuit voltage at the start.
  std::optional<double> nominal_voltage = {};
  double internal_resistance = 0;  ///< [ohm]
  double capacity = 10;            ///< [A h]
  double charge = 1;               ///< at the start, 0 … 1
  bool regenerates = true;         ///< braking motors charge it
};

/// [robot.actuators]: the supply that the actuators of a robot share.
struct SharedActuatorOptions {
  std::optional<BatteryOptions> battery = {};
  double idle_power = 0;  ///< constant electrical power of computers and drives [W]
  SourceLoc loc = {};
};

}  // namespace gloam
