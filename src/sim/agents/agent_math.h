#pragma once
// Vectors and rotations in double precision, for agents.

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "gloam/types.h"

namespace gloam {

using Vec3d = Vec3Of<double>;

inline Vec3d to_vec3d(const Vec3& v) { return {v.x, v.y, v.z}; }
inline double norm(Vec3d a) { return std::sqrt(dot(a, a)); }
inline double flat_norm(Vec3d a) { return std::sqrt(a.x * a.x + a.y * a.y); }
inline Vec3d flat(Vec3d a) { return {a.x, a.y, 0}; }
/// Unit vector along `a`; `otherwise` if `a` is zero.
inline Vec3d unit_or(Vec3d a, Vec3d otherwise) {
  const double n = norm(a);
  return n > 1e-9 ? a * (1 / n) : otherwise;
}
/// No longer than `most`.
inline Vec3d shortened(Vec3d a, double most) {
  const double n = norm(a);
  return n > most ? a * (most / n) : a;
}
inline Vec3d heading_vector(double heading) { return {std::cos(heading), std::sin(heading), 0}; }
/// Into (-pi, pi].
inline double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }
inline double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

inline Quat operator*(const Quat& a, const Quat& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
inline Vec3d rotated(const Quat& q, Vec3d v) {
  const Vec3d u{q.x, q.y, q.z};
  const Vec3d t = cross(u, v) * 2.0;
  return v + t * q.w + cross(u, t);
}
inline Quat turn_x(double angle) { return {std::cos(angle / 2), std::sin(angle / 2), 0, 0}; }
inline Quat turn_y(double angle) { return {std::cos(angle / 2), 0, std::sin(angle / 2), 0}; }
inline Quat turn_z(double angle) { return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}; }

/// Rotation of a frame whose axes have these directions in the world (Shepperd 1978).
inline Quat quat_of_axes(Vec3d x, Vec3d y, Vec3d z) {
  const double trace = x.x + y.y + z.z;
  Quat q;
  if (trace > 0) {
    const double s = 2 * std::sqrt(1 + trace);
    q = {s / 4, (y.z - z.y) / s, (z.x - x.z) / s, (x.y - y.x) / s};
  } else if (x.x > y.y && x.x > z.z) {
    const double s = 2 * std::sqrt(1 + x.x - y.y - z.z);
    q = {(y.z - z.y) / s, s / 4, (y.x + x.y) / s, (z.x + x.z) / s};
  } else if (y.y > z.z) {
    const double s = 2 * std::sqrt(1 + y.y - x.x - z.z);
    q = {(z.x - x.z) / s, (y.x + x.y) / s, s / 4, (z.y + y.z) / s};
  } else {
    const double s = 2 * std::sqrt(1 + z.z - x.x - y.y);
    q = {(x.y - y.x) / s, (z.x + x.z) / s, (z.y + y.z) / s, s / 4};
  }
  return q;
}

/// Pose of a part: origin [m] and rotation in the world.
struct PartPose {
  Vec3d p;
  Quat q;
};

/// Between two poses close to each other.
inline PartPose between(const PartPose& a, const PartPose& b, double t) {
  const double same = a.q.w * b.q.w + a.q.x * b.q.x + a.q.y * b.q.y + a.q.z * b.q.z;
  const double s = same < 0 ? -t : t, r = 1 - t;
  Quat q{r * a.q.w + s * b.q.w, r * a.q.x + s * b.q.x, r * a.q.y + s * b.q.y,
         r * a.q.z + s * b.q.z};
  const double n = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {a.p * r + b.p * t, {q.w * n, q.x * n, q.y * n, q.z * n}};
}

}  // namespace gloam
