#pragma once
// Smooth noise over a plane for the shape of ground, rocks and borders.

#include <cmath>
#include <cstdint>

#include "base/rng.h"

namespace gloam {

/// 0 below `low`, 1 above `high`, level at both ends.
inline double smooth_between(double low, double high, double x) {
  const double t = std::fmin(std::fmax((x - low) / (high - low), 0.0), 1.0);
  return t * t * (3 - 2 * t);
}

/// A function of the place and the seed alone, with continuous curvature.
class SmoothNoise {
 public:
  explicit SmoothNoise(uint64_t seed) : seed_(seed) {}

  /// -1 … 1, mean 0; x and y in cells.
  double operator()(double x, double y) const {
    const double fx = std::floor(x), fy = std::floor(y);
    const auto i = static_cast<int64_t>(fx), j = static_cast<int64_t>(fy);
    const double u = x - fx, v = y - fy;
    const double a = corner(i, j, u, v), b = corner(i + 1, j, u - 1, v),
                 c = corner(i, j + 1, u, v - 1), d = corner(i + 1, j + 1, u - 1, v - 1);
    const double s = fade(u), t = fade(v);
    return (a + s * (b - a)) * (1 - t) + (c + s * (d - c)) * t;
  }

  /// Octaves, each twice as fine and half as strong; about -1 … 1.
  double sum(double x, double y, int octaves) const {
    double total = 0, weight = 1, all = 0;
    for (int k = 0; k < octaves; ++k) {
      total += weight * (*this)(x + 17.3 * k, y - 9.1 * k);
      all += weight;
      weight /= 2, x *= 2, y *= 2;
    }
    return total / all;
  }

 private:
  static double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

  // A slope through the corner, in a direction of its own.
  double corner(int64_t i, int64_t j, double u, double v) const {
    const Philox4 d = philox4x32(seed_, static_cast<uint64_t>(i), static_cast<uint64_t>(j));
    const double angle = 2 * M_PI * uniform_double(d.v[0], d.v[1]);
    return 1.4 * (std::cos(angle) * u + std::sin(angle) * v);
  }

  uint64_t seed_;
};

}  // namespace gloam
