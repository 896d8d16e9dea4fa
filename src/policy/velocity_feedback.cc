#include "policy/velocity_feedback.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

// A robot that is held back must not run off when freed, and one that is pushed must recover first.
constexpr double kLargestCorrection = 0.4, kLargestError = 1;  // [m/s, rad/s]

/// vx, vy and yaw rate in the heading frame.
std::array<double, 3> planar_velocity(const RobotState& robot) {
  const auto& R = robot.R_WB;
  const auto in_world = [&](const std::array<double, 3>& v_B, size_t axis) {
    return R[3 * axis] * v_B[0] + R[3 * axis + 1] * v_B[1] + R[3 * axis + 2] * v_B[2];
  };
  const double vx = in_world(robot.v_B, 0), vy = in_world(robot.v_B, 1);
  const double length = std::max(std::hypot(R[0], R[3]), 1e-9);
  const double cosine = R[0] / length, sine = R[3] / length;
  return {cosine * vx + sine * vy, cosine * vy - sine * vx, in_world(robot.omega_B, 2)};
}

}  // namespace

std::array<double, 3> VelocityFeedback::correct(const std::array<double, 3>& command,
                                                const RobotState& robot, const PolicySpec& spec) {
  if (command == std::array<double, 3>{}) reset();
  if (spec.velocity_feedback == 0 || command == std::array<double, 3>{}) return command;
  const std::array<double, 3> velocity = planar_velocity(robot);
  std::array<double, 3> corrected;
  for (size_t i = 0; i < 3; ++i) {
    const double error = command[i] - velocity[i];
    const double step = std::abs(error) <= kLargestError ? error : 0;
    integral_[i] = std::clamp(integral_[i] + spec.velocity_feedback / spec.rate * step,
                              -kLargestCorrection, kLargestCorrection);
    corrected[i] =
        std::clamp(command[i] + integral_[i], spec.command_ranges[i][0], spec.command_ranges[i][1]);
  }
  return corrected;
}

}  // namespace gloam
