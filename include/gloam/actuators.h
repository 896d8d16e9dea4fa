#pragma once
// Readings of the actuator models of robots ([[robot.actuator]], docs/actuators.md).

#include <vector>

namespace gloam {

/// One actuator. NaN = not modelled.
struct DriveOutput {
  int actuator = -1;       ///< index in the World, as Actuator::id
  double force = 0;        ///< applied in the last step, in the actuator's space; NaN = none yet
  double current = 0;      ///< of the winding [A]
  double temperature = 0;  ///< of the winding [°C]
  double speed = 0;        ///< of the motor, in the last step [rad/s]
};

/// A robot with actuator models, after the last step. NaN = not modelled.
struct ActuatorOutputs {
  int robot = -1;                   ///< index in World::robots()
  double voltage = 0;               ///< of the battery [V]
  double current = 0;               ///< that the battery delivers [A]
  double charge = 0;                ///< of the battery, 0 … 1
  double capacity = 0;              ///< of the battery [A h]
  double power = 0;                 ///< electrical, of all actuators [W]
  double energy = 0;                ///< electrical, since the reset [J]
  std::vector<DriveOutput> drives;  ///< of joints in the model's order, then of propellers
};

}  // namespace gloam
