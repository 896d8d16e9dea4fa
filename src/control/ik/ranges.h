#pragma once
// Checks of the numbers that tasks and limits are given.

#include <span>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam::ik {

/// Error unless 0 <= gain <= 1 and lm_damping >= 0.
Status check_gains(double gain, double lm_damping);
/// Error unless all are finite and not negative.
Status check_costs(std::span<const double> costs);
/// Error unless it is finite and its quaternion is not zero.
Status check_pose(const Pose& X);
/// Error unless all are finite.
Status check_finite(std::span<const double> values, const char* what);
Error refuse_value(const char* what);

}  // namespace gloam::ik
