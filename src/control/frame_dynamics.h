#pragma once
// Dynamics of a frame and of the joints that move it, at one state.

#include "control/ik/kinematics.h"

namespace gloam {

/// All other joints are taken as not accelerating.
class FrameDynamics {
 public:
  /// `dofs`: degrees of freedom of the joints, (n).
  FrameDynamics(const mjModel& model, const ik::FrameId& frame, std::vector<int> dofs);
  /// A copy holds zeros until update().
  FrameDynamics(const FrameDynamics& other);
  FrameDynamics& operator=(const FrameDynamics&) = delete;

  /// Computes everything below at a state. Does not allocate.
  void update(const mjModel& model, const mjData& state);

  ik::Transform X_WF;
  ik::MatrixXd M;                               ///< inertia, (n x n) [kg m², kg]
  ik::MatrixXd J;                               ///< world axes, position first, (6 x n)
  ik::VectorXd bias;                            ///< Coriolis, centrifugal, gravity, (n) [N m, N]
  Eigen::Matrix<double, 6, 1> velocity, drift;  ///< of the frame: J v and J̇ v of all joints

 private:
  const mjModel* model_;
  ik::FrameId frame_;
  std::vector<int> dofs_;
  DataPtr data_;
  ik::RowMatrix jacobian_;             // (6 x nv)
  ik::VectorXd bias_, unit_, column_;  // (nv)
};

}  // namespace gloam
