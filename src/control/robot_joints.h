#pragma once
// Actuators of a robot by the joints that they drive.

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "world/world.h"

namespace gloam {

/// An actuator that drives one hinge or slide of a robot.
struct DrivenJoint {
  std::string name;  ///< of the joint, without the robot's prefix; "" when it has none
  int joint = -1;
  int actuator = -1;
  int ctrl = -1;  ///< index of its control
  int qpos = -1, dof = -1;
  double gear = 1;            ///< joint torque per unit of actuator force
  bool takes_target = false;  ///< position servo: its control is the joint's angle times the gear
  double gain = 1;            ///< else: actuator force per unit of control
  double lowest, highest;     ///< limits of the control; ±infinity when it has none
  double force_lowest, force_highest;  ///< limits of the actuator's force; ±infinity when none
};

/// In the order of the actuators. Actuators with another transmission, with activations, or with
/// more than one control are left out.
std::vector<DrivenJoint> driven_joints(const mjModel& model, const RobotInstance& robot);

}  // namespace gloam
