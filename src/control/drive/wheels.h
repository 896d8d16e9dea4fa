#pragma once
// The driven wheels of a base that steers by the difference of its wheels' speeds.

#include <vector>

#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

/// A wheel and its actuator.
struct Wheel {
  int ctrl = -1, dof = -1;
  bool takes_speed = false;  ///< velocity servo; else a motor
  double gear = 1;           ///< joint torque per unit of actuator force
  double gain = 1;           ///< of a motor: actuator force per unit of control
  double inertia = 0;        ///< of the wheel about its axis [kg m²]
  double lowest, highest;    ///< limits of the control
  double turn = 1;           ///< +1: a positive joint speed drives forward, -1: backward
};

struct WheeledBase {
  std::vector<Wheel> left, right;
  double radius = 0;  ///< of the wheels [m]
  double mass = 0;    ///< of the whole robot [kg]
  double track = 0;   ///< between the contact lines of left and right wheels [m]
};

/// Errors: joints that do not exist or are not driven; wheels on one side only; no radius.
Result<WheeledBase> find_wheels(const mjModel& model, const RobotInstance& robot);

}  // namespace gloam
