#pragma once
// Drive: an actuator of a robot with models of its own, and its quantities in one step.

#include <mujoco/mujoco.h>

#include <limits>
#include <string>
#include <vector>

#include "world/world.h"

namespace gloam {

/// The constant part of a drive: the actuator, its joint or propeller, and its options.
struct DriveSetup {
  std::string name;  ///< of the joint or, for a propeller, the actuator; without the robot's prefix
  int joint = -1, qpos = -1, dof = -1;  ///< -1: a propeller
  int site = -1;                        ///< of a propeller
  int actuator = -1;
  int ctrl = -1;              ///< index of its control
  int output = -1;            ///< index of its force
  bool takes_target = false;  ///< its force has a term of position or velocity: a servo
  ActuatorOptions options;
};

struct Drive {
  const DriveSetup* setup = nullptr;

  // State at the beginning of the present step.
  double position = 0, velocity = 0;  ///< of the joint [rad, rad/s]
  double command = 0;                 ///< control, within its limits and delayed
  double gear = 1;                    ///< joint torque, or thrust, per unit of actuator force
  double gain = 1, bias = 0;          ///< actuator force = gain · control + bias
  double demand = 0;                  ///< commanded torque at the joint, without limits [N m]
  double torque = 0;   ///< at the joint [N m], or thrust [N]; each model changes it, the last value
                       ///< is applied
  double current = 0;  ///< of the winding [A]
  double loss = 0;     ///< heat of the winding [W]

  // From one step to the next.
  double supply = 1;       ///< battery voltage over nominal voltage
  double derating = 1;     ///< share of the torque limit that the temperature leaves
  bool is_loose = false;   ///< the motor turns in the play of the gear …
  double loose_speed = 0;  ///< … at this speed, seen at the joint [rad/s]
  double inflow = 0;       ///< speed of a propeller through the air along its thrust [m/s], and …
  double shaft_speed = 0, shaft_torque = 0;  ///< … of its motor in this step [rad/s, N m]
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< of the winding [°C]
  double force = std::numeric_limits<double>::quiet_NaN();        ///< applied, of the actuator

  const ActuatorOptions& options() const { return setup->options; }
  bool is_propeller() const { return setup->site >= 0; }
  /// [rad/s]
  double motor_speed() const {
    if (is_propeller()) return shaft_speed;
    return options().gear_ratio * (is_loose ? loose_speed : velocity);
  }
  /// [N m]
  double motor_torque() const {
    return is_propeller() ? shaft_torque : torque / options().gear_ratio;
  }
};

/// The drives of a robot, in the order of its joints and then of its actuators at sites: of each
/// the last [[robot.actuator]] that matches its name. Errors, with the location of the table: it
/// matches nothing; a joint has no actuator or several; an actuator is neither a motor nor a servo,
/// or has activations; options that a servo or motor does not have.
Result<std::vector<DriveSetup>> find_drives(const mjModel& model, const RobotInstance& robot);

}  // namespace gloam
