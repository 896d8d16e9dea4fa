#pragma once
// Objective of the quadratic program: ½ xᵀ H x + cᵀ x for displacements x (n).

#include "control/ik/kinematics.h"

namespace gloam::ik {

struct Objective {
  MatrixXd H;  ///< (n x n)
  VectorXd c;  ///< (n)

  void reset(int n, double damping) {
    H.setZero(n, n);
    H.diagonal().setConstant(damping);
    c.setZero(n);
  }

  /// Adds ½ |w (J x + gain e)|² and ½ μ |x|² with μ = lm_damping |w gain e|². `J` (k x n) is
  /// overwritten by w J.
  template <class Jacobian, class Vector>
  void add(Jacobian&& J, const Vector& weight, const Vector& error, double gain,
           double lm_damping) {
    const Vector weighted = -gain * weight.cwiseProduct(error);
    J.array().colwise() *= weight.array();
    H.noalias() += J.transpose().lazyProduct(J);
    c.noalias() -= J.transpose().lazyProduct(weighted);
    H.diagonal().array() += lm_damping * weighted.squaredNorm();
  }
};

}  // namespace gloam::ik
