#pragma once
// From a thrust and torques to the thrusts of rotors within their limits.

#include <Eigen/Dense>

#include "control/flight/rotors.h"

namespace gloam {

/// Force along the base's z axis [N] and torque about the centre of mass [N m], base frame.
struct FlightWrench {
  double thrust = 0;
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
};

/// Distributes a wrench by the pseudo-inverse of the effectiveness. If limits do not allow all of
/// it, roll and pitch take precedence over thrust, and thrust over yaw, as in PX4's mixer: a
/// vehicle that keeps its attitude can recover everything else.
class RotorMixer {
 public:
  explicit RotorMixer(const Multirotor& vehicle);

  /// Writes the controls of all rotors. No allocation.
  void mix(const FlightWrench& wrench, double* ctrl);
  /// Thrusts from the last call [N], (rotors).
  const Eigen::VectorXd& thrusts() const { return thrusts_; }
  bool saturated() const { return saturated_; }  ///< the last wrench was reduced

 private:
  double largest_scale(const Eigen::VectorXd& part) const;

  std::vector<Rotor> rotors_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> inverse_;  ///< thrusts per unit of thrust and torques
  Eigen::VectorXd lowest_, highest_;                  // [N]
  Eigen::VectorXd thrusts_, part_;                    // [N]
  bool saturated_ = false;
};

}  // namespace gloam
