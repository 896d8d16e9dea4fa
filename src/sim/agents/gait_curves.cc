#include "sim/agents/gait_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gloam::gait {
namespace {

// Every 4 % of the cycle [deg].
constexpr std::array<double, 25> kPitch = {-14.7, -5.4, -1.1, 0.5,  0.8,  1.3,   2.2,  3.2,  4.6,
                                           6.3,   8.6,  12.3, 17.8, 26.0, 38.8,  59.9, 71.1, 66.4,
                                           55.5,  41.6, 26.4, 11.1, -3.2, -14.4, -19.3};
// Every 5 % of the cycle, over a half of it [m].
constexpr std::array<double, 10> kDescent = {0.0258, 0.0257, 0.0207, 0.0118, 0.0040,
                                             0.0000, 0.0006, 0.0056, 0.0133, 0.0212};
// Every twentieth of the swing. A foot comes down at rest, and clears the ground by 6 mm.
constexpr std::array<double, 21> kProgress = {0,     0.020, 0.058, 0.108, 0.165, 0.226, 0.290,
                                              0.356, 0.423, 0.491, 0.559, 0.627, 0.694, 0.760,
                                              0.822, 0.879, 0.925, 0.959, 0.982, 0.996, 1};
constexpr std::array<double, 21> kLift = {0,      0.0140, 0.0300, 0.0440, 0.0540, 0.0595, 0.0605,
                                          0.0595, 0.0575, 0.0555, 0.0525, 0.0455, 0.0345, 0.0270,
                                          0.0232, 0.0225, 0.0225, 0.0210, 0.0170, 0.0090, 0};

// Through four values, between the middle two (Catmull and Rom 1974).
double between(double a, double b, double c, double d, double t) {
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

template <size_t kCount>
double periodic(const std::array<double, kCount>& values, double phase) {
  const double x = (phase - std::floor(phase)) * kCount;
  const auto i = static_cast<size_t>(x);
  const auto at = [&](size_t k) { return values[(i + k) % kCount]; };
  return between(at(kCount - 1), at(0), at(1), at(2), x - static_cast<double>(i));
}

template <size_t kCount>
double open(const std::array<double, kCount>& values, double u) {
  constexpr size_t kLast = kCount - 1;
  const double x = u * kLast;
  const size_t i = x > 0 ? std::min(static_cast<size_t>(x), kLast - 1) : 0;
  return between(values[i > 0 ? i - 1 : 0], values[i], values[i + 1],
                 values[std::min(i + 2, kLast)], x - static_cast<double>(i));
}

}  // namespace

double foot_pitch(double phase) { return periodic(kPitch, phase) * std::numbers::pi / 180; }
double hip_descent(double phase) { return periodic(kDescent, 2 * phase); }
double swing_progress(double u) { return open(kProgress, u); }
double swing_pivot(double u) { return kToe + (kHeel - kToe) * u * u * (3 - 2 * u); }
double swing_lift(double u) { return open(kLift, u); }

}  // namespace gloam::gait
