#pragma once
// Poses and vectors of the public API, multiplied.

#include <cmath>

#include "gloam/types.h"

namespace gloam::bridge {

inline Vec3 sum(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 difference(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }
inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

inline Quat product(const Quat& a, const Quat& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
inline Quat inverse(const Quat& q) { return {q.w, -q.x, -q.y, -q.z}; }
/// R(q) v of a unit quaternion.
inline Vec3 rotate(const Quat& q, const Vec3& v) {
  const Vec3 u = {q.x, q.y, q.z}, t = cross(u, v);
  const Vec3 twice = {2 * t.x, 2 * t.y, 2 * t.z}, c = cross(u, twice);
  return {v.x + q.w * twice.x + c.x, v.y + q.w * twice.y + c.y, v.z + q.w * twice.z + c.z};
}
inline Pose product(const Pose& a, const Pose& b) {
  return {sum(a.p, rotate(a.q, b.p)), product(a.q, b.q)};
}
/// Makes a quaternion a unit; false where it is none: zero, not finite, or off by more than 1 %.
inline bool normalize(Quat* q) {
  const double norm = std::sqrt(q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z);
  if (!std::isfinite(norm) || std::abs(norm - 1) > 0.01) return false;
  *q = {q->w / norm, q->x / norm, q->y / norm, q->z / norm};
  return true;
}

}  // namespace gloam::bridge
