#pragma once
// Constraints of the quadratic program: bounds of displacements and inequalities G x <= h.

#include <algorithm>
#include <limits>

#include "control/ik/kinematics.h"

namespace gloam::ik {

struct Constraints {
  VectorXd lower, upper;  ///< of each displacement, ±infinity = none, (n)
  MatrixXd G;             ///< (m x n); a row of zeros = none
  VectorXd h;             ///< (m); infinity = none

  void reset() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    lower.setConstant(-kInfinity);
    upper.setConstant(kInfinity);
    G.setZero();
    h.setConstant(kInfinity);
  }
  void bound(int i, double low, double high) {
    lower[i] = std::max(lower[i], low);
    upper[i] = std::min(upper[i], high);
  }
};

/// Inequalities of one limit: those from `first` on are its own.
struct ConstraintRows {
  Constraints* all;
  int first;
  auto row(int i) { return all->G.row(first + i); }
  double& bound(int i) { return all->h[first + i]; }
};

}  // namespace gloam::ik
