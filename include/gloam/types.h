#pragma once
// Plain values that cross the public API. SI units, radians, Z up, quaternions wxyz.

#include <cstdint>

namespace gloam {

struct Vec3 {
  double x = 0, y = 0, z = 0;
  bool operator==(const Vec3&) const = default;
};

/// Unit quaternion in MuJoCo's order.
struct Quat {
  double w = 1, x = 0, y = 0, z = 0;
  bool operator==(const Quat&) const = default;
};

/// Pose of a frame B in a frame A: p_A = R(q) p_B + p. Named X_AB.
struct Pose {
  Vec3 p = {};  ///< origin of B in A [m]
  Quat q = {};  ///< rotation of B in A
  bool operator==(const Pose&) const = default;
};

/// An exact rate or period: `num / den`. Schedules use integer arithmetic and never compare floats.
struct Rational {
  int64_t num = 0;
  int64_t den = 1;
  double value() const { return static_cast<double>(num) / static_cast<double>(den); }
  bool operator==(const Rational&) const = default;
};

}  // namespace gloam
