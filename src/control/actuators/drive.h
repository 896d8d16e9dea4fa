#pragma once
// Drive: an actuator of a robot with models of its own, and its quantities in one step.

#include <mujoco/mujoco.h>

#include <limits>
#include <string>
#include <vector>

#include "world/world.h"

namespace gloam {

/// The constant part of a drive: the actuator, its joint and its options.
struct DriveSetup {
  std::string name;  ///< of the joint, without the robot's prefix
  int joint = -1, qpos = -1, dof = -1;
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
  double gear = 1;                    ///< joint torque per unit of actuator force
  double gain = 1, bias = 0;          ///< actuator force = gain · control + bias
  double demand = 0;                  ///< commanded torque at the joint, without limits [N m]
  double torque = 0;   ///< at the joint [N m]; each model changes it, the last value is applied
  double current = 0;  ///< of the winding [A]
  double loss = 0;     ///< heat of the winding [W]

  // From one step to the next.
  double supply = 1;       ///< battery voltage over nominal voltage
  double derating = 1;     ///< share of the torque limit that the temperature leaves
  bool is_loose = false;   ///< the motor turns in the play of the gear …
  double loose_speed = 0;  ///< … at this speed, seen at the joint [rad/s]
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< of the winding [°C]
  double force = std::numeric_limits<double>::quiet_NaN();        ///< applied, of the actuator

  const ActuatorOptions& options() const { return setup->options; }
  /// [rad/s]
  double motor_speed() const { return options().gear_ratio * (is_loose ? loose_speed : velocity); }
};

/// The drives of a robot, in the order of its joints: of each joint the last [[robot.actuator]]
/// that matches its name. Errors, with the location of the table: it matches no joint; a joint has
/// no actuator or several, or one that is no motor and no servo; options that a servo or motor does
/// not have.
Result<std::vector<DriveSetup>> find_drives(const mjModel& model, const RobotInstance& robot);

}  // namespace gloam
