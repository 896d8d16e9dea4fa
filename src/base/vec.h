#pragma once
// Small float vectors for geometry and light; device-safe. Public double-precision values are in
// gloam/types.h.

#include <cmath>

#include "base/device.h"
#include "base/member_list.h"

namespace gloam {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;

GLOAM_HD float min(float a, float b) { return a < b ? a : b; }
GLOAM_HD float max(float a, float b) { return a > b ? a : b; }
GLOAM_HD float clamp(float x, float lo, float hi) { return min(max(x, lo), hi); }
GLOAM_HD float lerp(float a, float b, float t) { return a + (b - a) * t; }
GLOAM_HD float sqr(float x) { return x * x; }
GLOAM_HD float square_root(float x) { return sqrtf(x); }
/// Square root that treats rounding below zero as zero.
GLOAM_HD float safe_sqrt(float x) { return sqrtf(max(x, 0.0f)); }
GLOAM_HD float select(bool condition, float a, float b) { return condition ? a : b; }

/// F: float, or the lanes of render/kernel/math/lanes.h.
template <class F>
struct Vec2Of {
  F x{}, y{};
  using Members = MemberList<&Vec2Of::x, &Vec2Of::y>;

  friend GLOAM_HD Vec2Of operator+(Vec2Of a, Vec2Of b) { return {a.x + b.x, a.y + b.y}; }
  friend GLOAM_HD Vec2Of operator-(Vec2Of a, Vec2Of b) { return {a.x - b.x, a.y - b.y}; }
  friend GLOAM_HD Vec2Of operator*(Vec2Of a, F s) { return {a.x * s, a.y * s}; }
};
using Vec2f = Vec2Of<float>;

/// F: float, or the lanes of render/kernel/math/lanes.h.
template <class F>
struct Vec3Of {
  F x{}, y{}, z{};
  using Members = MemberList<&Vec3Of::x, &Vec3Of::y, &Vec3Of::z>;

  GLOAM_HD F operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }

  friend GLOAM_HD Vec3Of operator+(Vec3Of a, Vec3Of b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend GLOAM_HD Vec3Of operator-(Vec3Of a, Vec3Of b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend GLOAM_HD Vec3Of operator-(Vec3Of a) { return {-a.x, -a.y, -a.z}; }
  friend GLOAM_HD Vec3Of operator*(Vec3Of a, Vec3Of b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend GLOAM_HD Vec3Of operator*(Vec3Of a, F s) { return {a.x * s, a.y * s, a.z * s}; }
  friend GLOAM_HD Vec3Of operator*(F s, Vec3Of a) { return a * s; }
  friend GLOAM_HD Vec3Of operator/(Vec3Of a, F s) { return a * (1.0f / s); }
  friend GLOAM_HD Vec3Of& operator+=(Vec3Of& a, Vec3Of b) { return a = a + b; }
  friend GLOAM_HD Vec3Of& operator*=(Vec3Of& a, Vec3Of b) { return a = a * b; }
  friend GLOAM_HD Vec3Of& operator*=(Vec3Of& a, F s) { return a = a * s; }
  friend GLOAM_HD auto operator==(Vec3Of a, Vec3Of b) {
    return (a.x == b.x) & (a.y == b.y) & (a.z == b.z);
  }
  friend GLOAM_HD F dot(Vec3Of a, Vec3Of b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend GLOAM_HD Vec3Of cross(Vec3Of a, Vec3Of b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend GLOAM_HD F length_squared(Vec3Of a) { return dot(a, a); }
  friend GLOAM_HD F length(Vec3Of a) { return square_root(dot(a, a)); }
  friend GLOAM_HD Vec3Of normalize(Vec3Of a) { return a * (1.0f / length(a)); }
  friend GLOAM_HD Vec3Of lerp(Vec3Of a, Vec3Of b, F t) { return a + (b - a) * t; }
  friend GLOAM_HD F max_component(Vec3Of a) { return max(a.x, max(a.y, a.z)); }
  /// Luminance of a linear Rec. 709 colour (ITU-R BT.709).
  friend GLOAM_HD F luminance(Vec3Of rgb) {
    return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z;
  }
};
using Vec3f = Vec3Of<float>;

/// Affine map of points of B into A: columns x, y, z are the images of B's axes, p that of its
/// origin. Named X_AB.
template <class F>
struct AffineOf {
  Vec3Of<F> x{F(1.0f), F(0.0f), F(0.0f)}, y{F(0.0f), F(1.0f), F(0.0f)},
      z{F(0.0f), F(0.0f), F(1.0f)}, p{F(0.0f), F(0.0f), F(0.0f)};
  using Members = MemberList<&AffineOf::x, &AffineOf::y, &AffineOf::z, &AffineOf::p>;
};
using Affine3f = AffineOf<float>;

template <class F>
GLOAM_HD Vec3Of<F> transform_vector(const AffineOf<F>& X_AB, Vec3Of<F> v_B) {
  return X_AB.x * v_B.x + X_AB.y * v_B.y + X_AB.z * v_B.z;
}
template <class F>
GLOAM_HD Vec3Of<F> transform_point(const AffineOf<F>& X_AB, Vec3Of<F> p_B) {
  return transform_vector(X_AB, p_B) + X_AB.p;
}
/// Column by column: between two poses close to each other.
template <class F>
GLOAM_HD AffineOf<F> lerp(const AffineOf<F>& a, const AffineOf<F>& b, F t) {
  return {lerp(a.x, b.x, t), lerp(a.y, b.y, t), lerp(a.z, b.z, t), lerp(a.p, b.p, t)};
}
/// X_AC = X_AB X_BC.
GLOAM_HD Affine3f operator*(const Affine3f& X_AB, const Affine3f& X_BC) {
  return {transform_vector(X_AB, X_BC.x), transform_vector(X_AB, X_BC.y),
          transform_vector(X_AB, X_BC.z), transform_point(X_AB, X_BC.p)};
}
/// Inverse of any invertible affine map (scales and shears allowed).
GLOAM_HD Affine3f inverse(const Affine3f& X) {
  const Vec3f yz = cross(X.y, X.z), zx = cross(X.z, X.x), xy = cross(X.x, X.y);
  const float inv_det = 1.0f / dot(X.x, yz);
  const Vec3f r0 = yz * inv_det, r1 = zx * inv_det, r2 = xy * inv_det;  // rows of the inverse
  Affine3f out;
  out.x = {r0.x, r1.x, r2.x};
  out.y = {r0.y, r1.y, r2.y};
  out.z = {r0.z, r1.z, r2.z};
  out.p = -transform_vector(out, X.p);
  return out;
}

/// Orthonormal frame with z along the unit vector n (Duff et al. 2017, "Building an Orthonormal
/// Basis, Revisited").
template <class F>
struct FrameOf {
  Vec3Of<F> x, y, z;
  GLOAM_HD static FrameOf from_z(Vec3Of<F> n) {
    const F sign = select(n.z < 0.0f, F(-1.0f), F(1.0f));
    const F a = -1.0f / (sign + n.z);
    const F b = n.x * n.y * a;
    return {
        {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }
  GLOAM_HD Vec3Of<F> to_local(Vec3Of<F> v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  GLOAM_HD Vec3Of<F> to_world(Vec3Of<F> v) const { return x * v.x + y * v.y + z * v.z; }
};
using Frame = FrameOf<float>;

}  // namespace gloam
