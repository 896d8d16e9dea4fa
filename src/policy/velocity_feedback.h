#pragma once
// Integral correction of a policy's velocity command: a network follows its command with an error
// that depends on the ground, because it estimates its velocity or does not observe it at all.

#include <array>

#include "policy/policy_spec.h"

namespace gloam {

class VelocityFeedback {
 public:
  /// `command` (vx, vy [m/s], yaw rate [rad/s]) plus the integral of its error, within the command
  /// ranges. Velocities are those of the heading frame: z is vertical, x along the base's x.
  /// A zero command resets the integral, so that a standing robot stays where it is. Errors above
  /// 1 (m/s, rad/s) are not integrated.
  std::array<double, 3> correct(const std::array<double, 3>& command, const RobotState& robot,
                                const PolicySpec& spec);
  void reset() { integral_ = {}; }

 private:
  std::array<double, 3> integral_ = {};  // [m/s, m/s, rad/s]
};

}  // namespace gloam
