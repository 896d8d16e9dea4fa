#pragma once
// SE(3): logarithm, its derivative and the adjoint. Twists have the translation first [m, rad].
// J. Solà, J. Deray, D. Atchuthan, "A micro Lie theory for state estimation in robotics", 2018.

#include "control/ik/kinematics.h"

namespace gloam::ik {

/// Logarithm of a pose, with a rotation of 0..π [rad].
Vector6d log(const Transform& X);
/// Derivative of log(X exp(τ)) by τ at τ = 0, (6 x 6). For rotations below 1e-5 rad it is the
/// identity, as in Mink, although the translation's part does not vanish there.
Matrix6d log_derivative(const Transform& X);
/// Ad(X_AB): twists in B to twists in A, (6 x 6).
Matrix6d adjoint(const Transform& X);

}  // namespace gloam::ik
