#pragma once
// Rays, hits and the sampling of simple domains; device-safe.

#include "base/vec.h"

namespace gloam {

struct Ray {
  Vec3f o, d;          ///< origin, unit direction
  float tmax = 1e30f;  ///< [m]
  float time = 0;      ///< 0 = shutter opens, 1 = it closes
};

/// What a Traverser reports: enough to find the surface again.
struct RayHit {
  float t = 0;             ///< distance [m]
  uint32_t instance = 0;   ///< row of SceneView::instances
  uint32_t primitive = 0;  ///< triangle of a mesh
  float u = 0, v = 0;      ///< barycentric weights of its second and third corner
  Vec3f normal;            ///< of a triangle's geometry, world, not normalised
};

/// Sine and cosine of 2 pi u, u in [0, 1): error < 1e-6; the same on every device.
GLOAM_HD void sincos_turn(float u, float* sine, float* cosine) {
  const float quadrant = floorf(u * 4.0f + 0.5f);
  const float x = (u - quadrant * 0.25f) * (2.0f * kPi);  // |x| <= pi / 4
  const float x2 = x * x;
  const float s = x * (1.0f + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040))));
  const float c = 1.0f + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  const int q = static_cast<int>(quadrant) & 3;
  const float a = (q & 1) != 0 ? c : s, b = (q & 1) != 0 ? s : c;
  *sine = (q & 2) != 0 ? -a : a;
  *cosine = (q == 1 || q == 2) ? -b : b;
}

/// Cosine-weighted direction about +z; pdf = z / pi. (Malley's method.)
GLOAM_HD Vec3f sample_cosine_hemisphere(Vec2f u) {
  const float r = sqrtf(u.x);
  float s, c;
  sincos_turn(u.y, &s, &c);
  return {r * c, r * s, safe_sqrt(1.0f - u.x)};
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
GLOAM_HD Vec3f sample_cone(float one_minus_cos, Vec2f u) {
  const float h = u.x * one_minus_cos;  // 1 - cos, kept small for narrow cones
  const float r = safe_sqrt(h * (2.0f - h));
  float s, c;
  sincos_turn(u.y, &s, &c);
  return {r * c, r * s, 1.0f - h};
}
GLOAM_HD float cone_pdf(float one_minus_cos) { return 1.0f / (2.0f * kPi * one_minus_cos); }

/// 1 - cos of the half angle whose sine squared is `sin2`, without cancellation.
GLOAM_HD float one_minus_cos_of(float sin2) { return sin2 / (1.0f + safe_sqrt(1.0f - sin2)); }

/// Distance at which a ray enters the sphere from outside, or -1.
GLOAM_HD float enter_sphere(const Ray& ray, Vec3f center, float radius) {
  const Vec3f f = ray.o - center;
  const float b = -dot(f, ray.d);
  const float c = dot(f, f) - radius * radius;
  const Vec3f closest = f + ray.d * b;  // stable for distant spheres (Haines et al., RT Gems 2019)
  const float disc = radius * radius - dot(closest, closest);
  if (disc < 0 || b < 0 || c < 0) return -1.0f;
  return c / (b + sqrtf(disc));
}

/// Weight of the technique with density `a` against one with density `b` (power heuristic).
GLOAM_HD float mis_weight(float a, float b) {
  if (a > 1e18f) return 1.0f;
  return a * a / (a * a + b * b);
}

/// More than the rounding [m] of the surface point p that was found at distance t.
GLOAM_HD float surface_step(Vec3f p, float t) {
  return 4e-6f * max(max(fabsf(p.x), max(fabsf(p.y), fabsf(p.z))), t) + 1e-7f;
}

/// Origin of a ray that leaves the surface at p, which was found at distance t: moved off it along
/// the geometric normal, to the side of `direction`.
GLOAM_HD Vec3f leave_surface(Vec3f p, Vec3f normal, Vec3f direction, float t) {
  const float step = surface_step(p, t);
  return p + normal * (dot(direction, normal) >= 0 ? step : -step);
}

}  // namespace gloam
