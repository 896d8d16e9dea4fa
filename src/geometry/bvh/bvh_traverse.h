#pragma once
// A ray through a BvhView. Device-safe. Neither cracks between triangles nor rounding of boxes lose
// a hit; of hits at the same distance the one with the least id and primitive counts, so that the
// result does not depend on the shape of the tree.

#include "geometry/bvh/bvh.h"
#include "geometry/motion_keys.h"

namespace gloam {

struct BvhHit {
  float t = 0;                          ///< distance in lengths of the ray's direction
  float u = 0, v = 0;                   ///< weights of a triangle's second and third corner
  uint32_t instance = 0, triangle = 0;  ///< rows of BvhView
  uint32_t id = ~0u, primitive = 0;
};

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
/// Of three, in one instruction on Hopper: distances above zero are ordered as their bits are. In
/// between the order of what lies below zero does not matter.
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

/// Whether the ray meets the box up to tmax, and where it enters.
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

/// Where the ray meets the triangle in (0, tmax], or -1. The products of edges and the ray are the
/// same from both sides of an edge, up to their sign: no ray slips between two triangles (Plücker
/// coordinates; Davidovič et al. 2012, "3D Rasterization: A Bridge between Rasterization and Ray
/// Casting").
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

/// Of a triangle of the instance, in its frame.
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

/// A shadow ray before another ray.
struct BvhShadow {
  Vec3f o, d;
  float tmax = 0;  ///< 0 = there is none
};

/// The closest hit up to tmax, or with `any` just whether there is one. `shadow`, if there may be
/// one, goes before: *shadowed tells whether it hits anything; where tmax is 0 it goes alone. On a
/// card both rays in one loop keep lanes at work that are done with one of them early.
/// `solids` answers for instances without triangles:
///   float meet(const BvhInstance&, Vec3f o_G, Vec3f d_G, float time, float tmax) const
/// is the distance in (0, tmax], or a value <= 0. kMoves: something may move in time. kByStep: a
/// turn of the loop is a node or a triangle, not all nodes on the way to a leaf and then the leaf:
/// no lane of a card waits for another's run, which ends few long rays sooner.
template <bool kMoves, bool kByStep, class Solids>
GLOAM_HD bool traverse(const BvhView& view, const Solids& solids, Vec3f o, Vec3f d, float time,
                       float tmax, bool any, BvhHit* hit, const BvhShadow* shadow = nullptr,
                       bool* shadowed = nullptr) {
  using namespace bvh;
  constexpr int kStack = kMeshDepth + kTopDepth + 2;
  BvhRef stack[kStack];
  int top = 0;
  stack[top++] = kNothing;  // the end
  bool in_shadow = shadow != nullptr && shadow->tmax > 0;
  if (!in_shadow && !(tmax > 0)) return false;
  Vec3f from = in_shadow ? shadow->o : o, along = in_shadow ? shadow->d : d;
  float best = in_shadow ? shadow->tmax : tmax;
  BvhRef ref = view.root;
  LocalRay local{from, along};
  BoxRay box = BoxRay::make(from, along);
  bool in_mesh = false;
  uint32_t instance = 0;
  bool found = false;
  while (true) {
    while ((ref & kKind) == 0) {
      const BvhNode node = view.nodes[ref];
      float near[2];
      const bool first = meets_box(node.center[0], node.half[0], box, best, &near[0]);
      const bool second = meets_box(node.center[1], node.half[1], box, best, &near[1]);
      if (first && second) {
        const bool swapped = near[1] < near[0];
        stack[top++] = swapped ? node.child[0] : node.child[1];
        ref = swapped ? node.child[1] : node.child[0];
      } else if (first || second) {
        ref = first ? node.child[0] : node.child[1];
      } else {
        ref = stack[--top];
      }
      if (kByStep) break;
    }
    bool enough = false;
    if ((ref & kKind) == kTriangles) {
      const BvhInstance& in = view.instances[instance];
      const uint32_t begin = first_triangle(ref), left = triangle_count(ref),
                     end = begin + (kByStep ? 1 : left);
      for (uint32_t i = begin; i < end; ++i) {
        const BvhTriangle* triangle = view.triangles + i;
        const Corners at = corners_at<kMoves>(view, in, triangle, time);
        float u, v;
        const float t = meet_triangle(at.a, at.b, at.c, local.o, local.d, best, &u, &v);
        if (!(t > 0)) continue;
        if (any || in_shadow) {
          enough = true;
          break;
        }
        const uint32_t primitive = triangle->primitive;
        if (found && t == best &&
            (hit->id < in.id || (hit->id == in.id && hit->primitive < primitive))) {
          continue;
        }
        *hit = {t, u, v, instance, i, in.id, primitive};
        best = t;
        found = true;
      }
      ref = kByStep && left > 1 ? triangles_ref(end, left - 1) : stack[--top];
    } else if ((ref & kKind) == kInstance) {
      const uint32_t next = ref & ~kKind;
      const BvhInstance& in = view.instances[next];
      const LocalRay inside = into_instance<kMoves>(view, in, from, along, time);
      if (in.root == kNothing) {
        const float t = solids.meet(in, inside.o, inside.d, time, best);
        if (t > 0) {
          if (any || in_shadow) {
            enough = true;
          } else if (!(found && t == best && hit->id < in.id)) {
            *hit = {t, 0, 0, next, 0, in.id, 0};
            best = t;
            found = true;
          }
        }
        ref = stack[--top];
      } else {
        instance = next;
        local = inside;
        box = BoxRay::make(inside.o, inside.d);
        in_mesh = true;
        stack[top++] = kNothing;
        ref = in.root;
      }
    }
    if (enough && !in_shadow) return true;
    if (ref != kNothing && !enough) continue;
    if (in_mesh && !enough) {
      in_mesh = false;  // what was put off before it lies in the world again
      local = {from, along};
      box = BoxRay::make(from, along);
      ref = stack[--top];
      if (ref != kNothing) continue;
    }
    if (!in_shadow) break;
    *shadowed = enough;
    if (!(tmax > 0)) break;
    in_shadow = false;
    in_mesh = false;
    from = o;
    along = d;
    best = tmax;
    local = {o, d};
    box = BoxRay::make(o, d);
    top = 1;
    ref = view.root;
  }
  return found;
}

}  // namespace gloam
