#pragma once
// A ray through a BvhView. Device-safe. Neither cracks between triangles nor rounding of boxes lose
// a hit; of hits at the same distance the one with the least id and primitive counts, so that the
// result does not depend on the shape of the tree.

#include "geometry/bvh.h"
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
GLOAM_HD float away_from_zero(float x) { return fabsf(x) < 1e-18f ? copysignf(1e-18f, x) : x; }

/// A ray as boxes are tested with it.
struct BoxRay {
  Vec3f inverse, scaled;  ///< one by the direction; the origin times that
  Vec3f slack;            ///< rounding of distances

  GLOAM_HD static BoxRay make(Vec3f o, Vec3f d) {
    constexpr float kRounding = 4e-7f;
    BoxRay r;
    r.inverse = {1.0f / away_from_zero(d.x), 1.0f / away_from_zero(d.y),
                 1.0f / away_from_zero(d.z)};
    r.scaled = o * r.inverse;
    r.slack = Vec3f{fabsf(r.scaled.x), fabsf(r.scaled.y), fabsf(r.scaled.z)} * kRounding;
    return r;
  }
};

/// Whether the ray meets the box up to tmax, and where it enters.
GLOAM_HD bool meets_box(Vec3f center, Vec3f half, const BoxRay& ray, float tmax, float* enter) {
  const float cx = center.x * ray.inverse.x - ray.scaled.x,
              cy = center.y * ray.inverse.y - ray.scaled.y,
              cz = center.z * ray.inverse.z - ray.scaled.z;
  const float hx = half.x * fabsf(ray.inverse.x) + ray.slack.x,
              hy = half.y * fabsf(ray.inverse.y) + ray.slack.y,
              hz = half.z * fabsf(ray.inverse.z) + ray.slack.z;
  *enter = most(most(cx - hx, cy - hy), most(cz - hz, 0.0f));
  const float leave = least(least(cx + hx, cy + hy), least(cz + hz, tmax));
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
GLOAM_HD Corners corners_at(const BvhView& view, const BvhInstance& instance,
                            const BvhTriangle* triangle, float time) {
  if (instance.key_step == 0 || !(time > 0)) return {triangle->a, triangle->b, triangle->c};
  float share;
  const BvhTriangle* from = triangle + instance.key_step * key_before(view.key_count, time, &share);
  const BvhTriangle* to = from + instance.key_step;
  return {lerp(from->a, to->a, share), lerp(from->b, to->b, share), lerp(from->c, to->c, share)};
}

struct LocalRay {
  Vec3f o, d;
};

GLOAM_HD LocalRay into_instance(const BvhView& view, const BvhInstance& instance, Vec3f o, Vec3f d,
                                float time) {
  if (instance.motion >= 0 && time > 0) {
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

/// The closest hit up to tmax, or with `any` just whether there is one. `solids` answers for
/// instances without triangles:
///   float meet(const BvhInstance&, Vec3f o_G, Vec3f d_G, float time, float tmax) const
/// is the distance in (0, tmax], or a value <= 0.
template <class Solids>
GLOAM_HD bool traverse(const BvhView& view, const Solids& solids, Vec3f o, Vec3f d, float time,
                       float tmax, bool any, BvhHit* hit) {
  using namespace bvh;
  constexpr int kStack = kMeshDepth + kTopDepth + 2;
  BvhRef stack[kStack];
  int top = 0;
  stack[top++] = kNothing;  // the end
  BvhRef ref = view.root;
  LocalRay local{o, d};
  BoxRay box = BoxRay::make(o, d);
  bool in_mesh = false;
  uint32_t instance = 0;
  float best = tmax;
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
    }
    if ((ref & kKind) == kTriangles) {
      const BvhInstance& in = view.instances[instance];
      const uint32_t begin = first_triangle(ref), end = begin + triangle_count(ref);
      for (uint32_t i = begin; i < end; ++i) {
        const BvhTriangle* triangle = view.triangles + i;
        const Corners at = corners_at(view, in, triangle, time);
        float u, v;
        const float t = meet_triangle(at.a, at.b, at.c, local.o, local.d, best, &u, &v);
        if (!(t > 0)) continue;
        if (any) return true;
        const uint32_t primitive = triangle->primitive;
        if (found && t == best &&
            (hit->id < in.id || (hit->id == in.id && hit->primitive < primitive))) {
          continue;
        }
        *hit = {t, u, v, instance, i, in.id, primitive};
        best = t;
        found = true;
      }
      ref = stack[--top];
    } else if ((ref & kKind) == kInstance) {
      const uint32_t next = ref & ~kKind;
      const BvhInstance& in = view.instances[next];
      const LocalRay inside = into_instance(view, in, o, d, time);
      if (in.root == kNothing) {
        const float t = solids.meet(in, inside.o, inside.d, time, best);
        if (t > 0) {
          if (any) return true;
          if (!(found && t == best && hit->id < in.id)) {
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
    if (ref == kNothing) {
      if (!in_mesh) break;
      in_mesh = false;  // what was put off before it lies in the world again
      local = {o, d};
      box = BoxRay::make(o, d);
      ref = stack[--top];
      if (ref == kNothing) break;
    }
  }
  return found;
}

}  // namespace gloam
