#pragma once
// A ray through a BvhView. Device-safe. Neither cracks between triangles nor rounding of boxes lose
// a hit; of hits at the same distance the one with the least id and primitive counts, so that the
// result does not depend on the shape of the tree.

#include "geometry/bvh/bvh.h"
#include "geometry/bvh/bvh_ray.h"

namespace gloam {

struct BvhHit {
  float t = 0;                          ///< distance in lengths of the ray's direction
  float u = 0, v = 0;                   ///< weights of a triangle's second and third corner
  uint32_t instance = 0, triangle = 0;  ///< rows of BvhView
  uint32_t id = ~0u, primitive = 0;
};

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
/// no lane of a card waits for another's run, which ends few long rays sooner. `clear`, if not
/// null: with `any`, instances that may let light through are passed, and *clear is then set.
template <bool kMoves, bool kByStep, class Solids>
GLOAM_HD bool traverse(const BvhView& view, const Solids& solids, Vec3f o, Vec3f d, float time,
                       float tmax, bool any, BvhHit* hit, const BvhShadow* shadow = nullptr,
                       bool* shadowed = nullptr, bool* clear = nullptr) {
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
      const bool passes = clear != nullptr && any && in.is_clear != 0;
      const LocalRay inside = into_instance<kMoves>(view, in, from, along, time);
      if (passes) {
        *clear = true;
        ref = stack[--top];
      } else if (in.root == kNothing) {
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
      in_mesh = false;  // references pushed before it are in the world again
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
