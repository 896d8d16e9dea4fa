#include "policy/terms/gait.h"

#include <cmath>
#include <numbers>

namespace gloam {
namespace {

constexpr double kHalfTurn = std::numbers::pi;  // [rad]
constexpr double kStill = 0.01;  // holosoma: [m/s], [rad/s] below which a command means standing

double fraction(double x) { return x - std::floor(x); }

bool is_below(std::span<const double> command, double speed) {
  return std::sqrt(command[0] * command[0] + command[1] * command[1]) < speed &&
         std::abs(command[2]) < speed;
}

}  // namespace

void GaitClock::tick(const GaitOptions& options, std::span<const double> command, double rate) {
  index_ = is_below(command, options.still_speed)
               ? 0
               : fraction(index_ + options.value(GaitValue::kFrequency) / rate);
  const double step = 2 * kHalfTurn / (options.period * rate);
  for (double& phase : legs_)
    phase = std::fmod(phase + step + kHalfTurn, 2 * kHalfTurn) - kHalfTurn;
  if (is_below(command, kStill)) {
    legs_ = {kHalfTurn, kHalfTurn};
    stands_ = true;
  } else if (stands_) {
    legs_ = {0, kHalfTurn};
    stands_ = false;
  }
}

std::array<double, 4> GaitClock::feet(const GaitOptions& options) const {
  const double phase = options.value(GaitValue::kPhase);
  const double offset = options.value(GaitValue::kOffset);
  const double bound = options.value(GaitValue::kBound);
  const double duration = options.value(GaitValue::kDuration);
  const double front_right = options.pacing_offset ? bound : offset;
  const double rear_left = options.pacing_offset ? offset : bound;
  std::array<double, 4> clock = {phase + offset + bound, front_right, rear_left, phase};
  for (double& foot : clock) {
    const double f = fraction(index_ + foot);
    const double warped =
        f < duration ? 0.5 * f / duration : 0.5 + 0.5 * (f - duration) / (1 - duration);
    foot = std::sin(2 * kHalfTurn * warped);
  }
  return clock;
}

}  // namespace gloam
