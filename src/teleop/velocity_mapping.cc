#include "teleop/velocity_mapping.h"

#include <algorithm>
#include <cmath>

namespace gloam::teleop {
namespace {

constexpr double kDeflectionSteps = 50;

double scaled(const VelocityRange& range, double deflection, double fraction, double usual) {
  const double rounded = std::round(deflection * kDeflectionSteps) / kDeflectionSteps;
  const double limit = rounded < 0 ? std::max(-range.low, 0.0) : std::max(range.high, 0.0);
  const double value = rounded * fraction * (std::isfinite(limit) ? limit : usual);
  return value == 0 ? 0 : std::clamp(value, range.low, range.high);
}

}  // namespace

SetVelocityGoal velocity_goal(Robot robot, const VelocityRanges& ranges, Deflection move,
                              int speed) {
  if (ranges.vy.is_zero()) move.turn = std::clamp(move.turn + move.left, -1.0, 1.0);
  const double fraction = static_cast<double>(speed) / kFastest;
  return {.robot = robot,
          .vx = scaled(ranges.vx, move.forward, fraction, 1),
          .vy = scaled(ranges.vy, move.left, fraction, 0.5),
          .yaw_rate = scaled(ranges.yaw_rate, move.turn, fraction, 1),
          .vz = scaled(ranges.vz, move.up, fraction, 1)};
}

bool is_same(const SetVelocityGoal& a, const SetVelocityGoal& b) {
  return a.vx == b.vx && a.vy == b.vy && a.yaw_rate == b.yaw_rate && a.vz == b.vz;
}

}  // namespace gloam::teleop
