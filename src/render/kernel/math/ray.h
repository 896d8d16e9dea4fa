#pragma once
// Rays, hits and the sampling of simple domains; device-safe.

#include "render/kernel/math/lanes.h"

namespace gloam {

template <class F>
struct RayOf {
  Vec3Of<F> o, d;     ///< origin, unit direction
  F tmax = F(1e30f);  ///< [m]
  F time = F(0.0f);   ///< 0 = shutter opens, 1 = it closes
  using Members = MemberList<&RayOf::o, &RayOf::d, &RayOf::tmax, &RayOf::time>;
};
using Ray = RayOf<float>;

/// Hit that a Traverser reports: enough to find the surface again.
template <class F>
struct RayHitOf {
  F t{};                  ///< distance [m]
  UintOf<F> instance{};   ///< row of SceneView::instances
  UintOf<F> primitive{};  ///< triangle of a mesh
  F u{}, v{};             ///< barycentric weights of its second and third corner
  Vec3Of<F> normal;       ///< of a triangle's geometry, world, not normalised
  using Members = MemberList<&RayHitOf::t, &RayHitOf::instance, &RayHitOf::primitive, &RayHitOf::u,
                             &RayHitOf::v, &RayHitOf::normal>;
};
using RayHit = RayHitOf<float>;

/// Sine and cosine of 2 pi u, u in [0, 1): error < 1e-6; the same on every device.
template <class F>
GLOAM_HD void sincos_turn(F u, F* sine, F* cosine) {
  const F quadrant = floor_of(u * 4.0f + 0.5f);
  const F x = (u - quadrant * 0.25f) * (2.0f * kPi);  // |x| <= pi / 4
  const F x2 = x * x;
  const F s = x * (1.0f + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040))));
  const F c = 1.0f + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  const UintOf<F> q = to_uint(quadrant);
  const auto odd = (q & 1u) != 0u;
  const F a = select(odd, c, s), b = select(odd, s, c);
  *sine = select((q & 2u) != 0u, -a, a);
  *cosine = select(((q + 1u) & 2u) != 0u, -b, b);
}

/// Logarithm of a normal x > 0: error < 1e-6 of it; the same on every device.
template <class F>
GLOAM_HD F natural_log(F x) {
  // x = m 2^(e - 127) with m in [1 / sqrt(2), sqrt(2)).
  const UintOf<F> half = 0x3F3504F3u, shifted = to_bits(x) + UintOf<F>(0x3F800000u - 0x3F3504F3u);
  const F e = to_float(shifted >> 23), m = from_bits((shifted & UintOf<F>(0x007FFFFFu)) + half);
  const F s = (m - 1.0f) / (m + 1.0f), s2 = s * s;  // log m = 2 artanh s
  const F series = 1.0f + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9))));
  return (e - 127.0f) * 0.69314718f + 2.0f * s * series;
}

/// A point of the unit disc, by area, as its squared radius and the turns about the centre: both
/// uniform in [0, 1), and of compact patches of u compact patches of the disc (Shirley and Chiu
/// 1997, "A low distortion map between disk and square").
template <class F>
GLOAM_HD Vec2Of<F> to_disc(Vec2Of<F> u) {
  const F a = u.x * 2.0f - 1.0f, b = u.y * 2.0f - 1.0f;
  const MaskOf<F> wide = magnitude(a) > magnitude(b);
  const F r = select(wide, a, b), across = select(wide, b, a);
  const F q = across / select(magnitude(r) > 0.0f, r, F(1.0f));
  const F turn = select(wide, q, 2.0f - q) * 0.125f + select(r < 0.0f, F(0.5f), F(0.0f));
  return {min(r * r, 0.99999994f), select(turn < 0.0f, turn + 1.0f, turn)};
}

/// Cosine-weighted direction about +z, pdf = z / pi, over a point of the unit disc: its squared
/// radius and the turns about the centre. (Malley's method.)
template <class F>
GLOAM_HD Vec3Of<F> cosine_direction(Vec2Of<F> disc) {
  const F r = square_root(disc.x);
  F s, c;
  sincos_turn(disc.y, &s, &c);
  return {r * c, r * s, safe_sqrt(1.0f - disc.x)};
}
template <class F>
GLOAM_HD Vec3Of<F> sample_cosine_hemisphere(Vec2Of<F> u) {
  return cosine_direction(to_disc(u));
}

/// Remainder of x, uniform in [0, 1), after a choice by x took the interval that begins at `from`
/// and is as long as `width`: where in it x lies, uniform in [0, 1) again. Points that are spread
/// evenly stay so in each interval.
template <class F>
GLOAM_HD F rest_of(F x, F from, F width) {
  return clamp((x - from) / width, 0.0f, 0.99999994f);
}

/// Uniform direction on the unit sphere; pdf = 1 / (4 pi).
GLOAM_HD Vec3f sample_sphere(Vec2f u) {
  const float z = 1.0f - 2.0f * u.x, r = safe_sqrt(1.0f - z * z);
  float s, c;
  sincos_turn(u.y, &s, &c);
  return {r * c, r * s, z};
}

/// Uniform direction in the cone about +z with 1 - cos(half angle) = `one_minus_cos`;
/// pdf = cone_pdf(one_minus_cos).
template <class F>
GLOAM_HD Vec3Of<F> sample_cone(F one_minus_cos, Vec2Of<F> u) {
  u = to_disc(u);
  const F h = u.x * one_minus_cos;  // 1 - cos, kept small for narrow cones
  const F r = safe_sqrt(h * (2.0f - h));
  F s, c;
  sincos_turn(u.y, &s, &c);
  return {r * c, r * s, 1.0f - h};
}
template <class F>
GLOAM_HD F cone_pdf(F one_minus_cos) {
  return 1.0f / (2.0f * kPi * one_minus_cos);
}

/// 1 - cos of the half angle whose sine squared is `sin2`, without cancellation.
template <class F>
GLOAM_HD F one_minus_cos_of(F sin2) {
  return sin2 / (1.0f + safe_sqrt(1.0f - sin2));
}

/// Distance at which a ray enters the sphere from outside, or -1.
template <class F>
GLOAM_HD F enter_sphere(const RayOf<F>& ray, Vec3f center, float radius) {
  const Vec3Of<F> f = ray.o - in_all_lanes<F>(center);
  const F b = -dot(f, ray.d);
  const F c = dot(f, f) - radius * radius;
  const Vec3Of<F> closest =
      f + ray.d * b;  // stable for distant spheres (Haines et al., RT Gems 2019)
  const F disc = radius * radius - dot(closest, closest);
  return select((disc < 0.0f) | (b < 0.0f) | (c < 0.0f), F(-1.0f), c / (b + safe_sqrt(disc)));
}

/// Weight of the technique with density `a` against one with density `b` (power heuristic).
template <class F>
GLOAM_HD F mis_weight(F a, F b) {
  return select(a > 1e18f, F(1.0f), a * a / (a * a + b * b));
}

/// Bound of the rounding [m] of the surface point p that was found at distance t.
template <class F>
GLOAM_HD F surface_step(Vec3Of<F> p, F t) {
  return 4e-6f * max(max(magnitude(p.x), max(magnitude(p.y), magnitude(p.z))), t) + 1e-7f;
}

/// Origin of a ray that leaves the surface at p, which was found at distance t: moved off it along
/// the geometric normal, to the side of `direction`.
template <class F>
GLOAM_HD Vec3Of<F> leave_surface(Vec3Of<F> p, Vec3Of<F> normal, Vec3Of<F> direction, F t) {
  const F step = surface_step(p, t);
  return p + normal * select(dot(direction, normal) >= 0.0f, step, -step);
}

}  // namespace gloam
