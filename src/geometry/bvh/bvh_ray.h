#pragma once
// Tests of a ray with boxes, triangles and instances of a BvhView. Device-safe. Neither cracks
// between triangles nor rounding of boxes lose a hit.

#include "geometry/bvh/bvh.h"
#include "geometry/motion_keys.h"

namespace gloam {

namespace bvh {

GLOAM_HD float least(float a, float b) {
#ifdef __CUDA_ARCH__
  return fminf(a, b);
#else
  return a < b ? a : b;
#endif
}
GLOAM_HD float most(float a, float b) {
#ifdef __CUDA_ARCH__
  return fmaxf(a, b);
#else
  return a > b ? a : b;
#endif
}
/// Within rounding: a card has an instruction for that, and ten for the last bit.
GLOAM_HD float about_one_by(float x) {
#ifdef __CUDA_ARCH__
  return __fdividef(1.0f, x);
#else
  return 1.0f / x;
#endif
}
GLOAM_HD float away_from_zero(float x) { return fabsf(x) < 1e-18f ? copysignf(1e-18f, x) : x; }

/// A ray as boxes are tested with it.
struct BoxRay {
  Vec3f inverse, scaled;  ///< one by the direction; the origin times that
  Vec3f slack;            ///< rounding of distances

  GLOAM_HD static BoxRay make(Vec3f o, Vec3f d) {
    constexpr float kRounding = 6e-7f;
    BoxRay r;
    r.inverse = {about_one_by(away_from_zero(d.x)), about_one_by(away_from_zero(d.y)),
                 about_one_by(away_from_zero(d.z))};
    r.scaled = o * r.inverse;
    r.slack = Vec3f{fabsf(r.scaled.x), fabsf(r.scaled.y), fabsf(r.scaled.z)} * kRounding;
    return r;
  }
};

#ifdef __CUDA_ARCH__
/// Greatest of three, in one instruction on Hopper: distances above zero are ordered as their bits
/// are. The order of values below zero does not matter here.
__device__ __forceinline__ float most_or_zero(float a, float b, float c) {
  return __int_as_float(__vimax3_s32_relu(__float_as_int(a), __float_as_int(b), __float_as_int(c)));
}
__device__ __forceinline__ float least_of_three(float a, float b, float c) {
  return __int_as_float(__vimin3_s32(__float_as_int(a), __float_as_int(b), __float_as_int(c)));
}
#else
inline float most_or_zero(float a, float b, float c) { return most(most(a, b), most(c, 0.0f)); }
inline float least_of_three(float a, float b, float c) { return least(least(a, b), c); }
#endif

/// True if the ray meets the box up to tmax; `enter` is the distance where it enters.
GLOAM_HD bool meets_box(Vec3f center, Vec3f half, const BoxRay& ray, float tmax, float* enter) {
  const float cx = center.x * ray.inverse.x - ray.scaled.x,
              cy = center.y * ray.inverse.y - ray.scaled.y,
              cz = center.z * ray.inverse.z - ray.scaled.z;
  const float hx = half.x * fabsf(ray.inverse.x) + ray.slack.x,
              hy = half.y * fabsf(ray.inverse.y) + ray.slack.y,
              hz = half.z * fabsf(ray.inverse.z) + ray.slack.z;
  *enter = most_or_zero(cx - hx, cy - hy, cz - hz);
  const float leave = least(least_of_three(cx + hx, cy + hy, cz + hz), tmax);
  return *enter <= leave;
}

/// Distance at which the ray meets the triangle in (0, tmax], or -1. The products of edges and the
/// ray are the same from both sides of an edge, up to their sign: no ray slips between two
/// triangles (Plücker coordinates; Davidovič et al. 2012, "3D Rasterization: A Bridge between
/// Rasterization and Ray Casting").
GLOAM_HD float meet_triangle(Vec3f a_W, Vec3f b_W, Vec3f c_W, Vec3f o, Vec3f d, float tmax,
                             float* u, float* v) {
  const Vec3f a = a_W - o, b = b_W - o, c = c_W - o;
  const Vec3f ca = c - a, ab = a - b, bc = b - c;
  const float wb = dot(cross(ca, c + a), d), wc = dot(cross(ab, a + b), d),
              wa = dot(cross(bc, b + c), d);
  const bool inside = least(least(wa, wb), wc) >= 0 || most(most(wa, wb), wc) <= 0;
  if (!inside) return -1.0f;
  const Vec3f n = cross(ab, ca);
  const float t = dot(a, n) / dot(n, d);
  if (!(t > 0 && t <= tmax)) return -1.0f;
  const float sum = wa + wb + wc;
  *u = wb / sum;
  *v = wc / sum;
  return t;
}

struct Corners {
  Vec3f a, b, c;
};

/// Corners of a triangle of the instance, in its frame.
template <bool kMoves>
GLOAM_HD Corners corners_at(const BvhView& view, const BvhInstance& instance,
                            const BvhTriangle* triangle, float time) {
  if (!kMoves || instance.key_step == 0 || !(time > 0))
    return {triangle->a, triangle->b, triangle->c};
  float share;
  const BvhTriangle* from = triangle + instance.key_step * key_before(view.key_count, time, &share);
  const BvhTriangle* to = from + instance.key_step;
  return {lerp(from->a, to->a, share), lerp(from->b, to->b, share), lerp(from->c, to->c, share)};
}

struct LocalRay {
  Vec3f o, d;
};

template <bool kMoves>
GLOAM_HD LocalRay into_instance(const BvhView& view, const BvhInstance& instance, Vec3f o, Vec3f d,
                                float time) {
  if (kMoves && instance.motion >= 0 && time > 0) {
    float share;
    const Affine3f* key = view.motion + instance.motion + key_before(view.key_count, time, &share);
    const Affine3f X_GW = inverse(lerp(key[0], key[1], share));
    return {transform_point(X_GW, o), transform_vector(X_GW, d)};
  }
  const Vec3f* row = instance.row;
  return {Vec3f{dot(row[0], o), dot(row[1], o), dot(row[2], o)} + instance.shift,
          {dot(row[0], d), dot(row[1], d), dot(row[2], d)}};
}

}  // namespace bvh

}  // namespace gloam
