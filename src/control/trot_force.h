#pragma once
// Ground forces that give the body the wanted acceleration: a small quadratic programme over the
// friction pyramids of the feet that stand.

#include <Eigen/Dense>
#include <array>

#include "control/trot_options.h"

namespace gloam {

struct ForceProblem {
  std::array<bool, 4> stands{};
  std::array<Eigen::Vector3d, 4> foot;  ///< from the robot's centre of mass, world axes [m]
  Eigen::Matrix<double, 6, 1> wrench;   ///< wanted force [N], moment about the centre of mass [N m]
  Eigen::Matrix3d R_WH;  ///< axes of the weights and pyramids: heading frame (x ahead, z up)
};

/// Minimises |W (A f - wrench)|² + a |f|² + b |f - f_last|² with every f inside its pyramid
/// |fx|, |fy| <= mu fz. A force is written as a non-negative mix of its pyramid's four edges, so
/// the only constraint is non-negativity; solved by a fixed number of projected Gauss-Seidel sweeps
/// started from the last solution. No allocation.
class ForceDistribution {
 public:
  explicit ForceDistribution(const TrotOptions& options) : options_(options) { reset(); }
  void reset();
  /// Forces on the feet, world axes [N]; zero for feet that do not stand.
  const std::array<Eigen::Vector3d, 4>& solve(const ForceProblem& problem);

 private:
  TrotOptions options_;
  Eigen::Matrix<double, 16, 1> mix_;      ///< of the last solution
  std::array<Eigen::Vector3d, 4> force_;  ///< of the last solution
};

}  // namespace gloam
