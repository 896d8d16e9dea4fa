#pragma once
// The rotors of a multirotor: actuators that push at sites, and the wrench that they can produce.

#include <Eigen/Dense>
#include <vector>

#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

/// One rotor. Its thrust is in newtons.
struct Rotor {
  int ctrl = -1;           ///< index of its control
  double gain = 1;         ///< thrust per unit of control [N]
  double lowest, highest;  ///< limits of the thrust [N]
};

/// A multirotor as its controller sees it. B = base body, at the model's initial configuration.
struct Multirotor {
  int qpos = -1, dof = -1;    ///< of its free joint
  double mass = 0;            ///< of the whole robot [kg]
  Eigen::Matrix3d inertia_B;  ///< of the whole robot about its centre of mass [kg m²]
  std::vector<Rotor> rotors;
  /// (4, rotors): force along B's z [N] and torque about the centre of mass in B [N m] per newton
  /// of each rotor's thrust.
  Eigen::Matrix<double, 4, Eigen::Dynamic> effectiveness;
};

/// Errors: no free joint, or rotors that cannot produce a thrust and torques about three axes.
Result<Multirotor> find_multirotor(const mjModel& model, const RobotInstance& robot);

}  // namespace gloam
