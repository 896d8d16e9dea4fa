#pragma once
// Selects one of many lights in proportion to a bound of its contribution at a point: from the root
// down, at each node by the bounds of its two children. Conty Estevez & Kulla 2018, "Importance
// sampling of many lights with adaptive tree splitting" (the bounds of place and direction). Theirs
// weighs a cluster by its centre's distance alone; a receiver among the lamps of a long corridor
// then goes to the far ones too often, so here the inverse square of the distance is averaged over
// the cluster's box. Device-safe.

#include "render/kernel/math/ray.h"
#include "render/kernel/scene_view.h"

namespace gloam {

/// One light of a tree; probability 0: none of them brings anything.
struct LightChoice {
  uint32_t light = 0;
  float probability = 0;
  float rest = 0;  ///< uniform in [0, 1), independent of the choice
};

namespace light_tree {

/// acos within 7e-5 (Abramowitz & Stegun 1964, 4.4.45).
GLOAM_HD float fast_acos(float x) {
  const float a = min(fabsf(x), 1.0f);
  const float y =
      sqrtf(1.0f - a) * (1.5707288f + a * (-0.2121144f + a * (0.0742610f - 0.0187293f * a)));
  return x >= 0 ? y : kPi - y;
}

/// Angle of the vector (x, y), y > 0, from the x axis, in (0, pi), within 2e-4 of itself
/// (Abramowitz & Stegun 1964, 4.4.47).
GLOAM_HD float fast_angle(float x, float y) {
  const float a = fabsf(x), q = min(a, y) / max(a, y), s = q * q;
  float angle =
      q * (0.9998660f + s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + 0.0208351f * s))));
  if (y > a) angle = 0.5f * kPi - angle;
  return x >= 0 ? angle : kPi - angle;
}

inline constexpr float kAngleSlack = 1e-3f;  // [rad]: bounds stay bounds despite rounding

/// Falloff from one where angle <= 0 down to a little at `falloff`: near enough to a cosine and to
/// a spot's rim. Zero beyond.
GLOAM_HD float fade(float angle, float falloff) {
  if (angle <= 0) return 1;
  const float x = angle / max(falloff, 1e-6f);
  return x >= 1 ? 0.0f : max(1.0f - x * x, 0.02f);
}

/// Mean of 1 / distance² over the box of half size h whose centre is at `to`: along its longest
/// edge by the integral, across it with mean squares.
GLOAM_HD float mean_inverse_square(Vec3f to, Vec3f h, float d2) {
  const bool x = h.x >= h.y && h.x >= h.z, y = !x && h.y >= h.z;
  const float e = x ? h.x : (y ? h.y : h.z), along = x ? to.x : (y ? to.y : to.z);
  const float e2 = e * e, h2 = dot(h, h), along2 = along * along;
  const float across2 =
      max(max(d2 - along2, 0.0f) + (h2 - e2) * (1.0f / 3.0f), max(1e-4f * e2, 1e-12f));
  const float near2 = across2 + along2;
  if (e2 < 1e-3f * near2) return 1.0f / near2;
  const float width = 2.0f * e * sqrtf(across2);
  return fast_angle(near2 - e2, width) / width;
}

/// Bound, up to a factor, of what the node's lights bring to a surface at p with the unit normal n
/// if nothing is in between; n = 0 takes light from all sides. Zero only if they bring nothing.
GLOAM_HD float bound(const LightNode& node, Vec3f p, Vec3f n) {
  constexpr float kMinImportance = 1e-36f;  // that a bound does not vanish by rounding
  if (!(node.power > 0)) return 0;
  const bool has_side = n.x != 0 || n.y != 0 || n.z != 0;
  if ((node.flags & LightNode::kFar) != 0) {
    float cosine = 1;
    if (has_side) {
      const float angle = fast_acos(-dot(node.axis, n)) - node.spread - kAngleSlack;
      if (angle >= 0.5f * kPi) return 0;
      cosine = fade(angle, 0.5f * kPi);
    }
    return max(node.power * (cosine + 0.05f), kMinImportance);
  }
  const Vec3f to = node.center - p, h = node.half;
  const float d2 = dot(to, to), r2 = dot(h, h);
  float weight = node.power;
  if (has_side) {
    const float height = dot(to, n) + fabsf(n.x) * h.x + fabsf(n.y) * h.y + fabsf(n.z) * h.z;
    if (!(height > 0)) return 0;
    weight *= min(height / sqrtf(max(max(d2, r2), 1e-20f)), 1.0f) + 0.05f;
  }
  if (node.spread + node.falloff < kPi && d2 > r2) {
    const float inv_d = 1.0f / sqrtf(d2);
    const float seen_within = 0.5f * kPi - fast_acos(sqrtf(r2) * inv_d);  // of the box
    const float facing =
        fade(fast_acos(-dot(to, node.axis) * inv_d) - node.spread - seen_within - kAngleSlack,
             node.falloff);
    if (!(facing > 0)) return 0;
    weight *= facing;
  }
  return max(weight * mean_inverse_square(to, h, d2), kMinImportance);
}

/// Probabilities of the three roots. Occlusion is not known, so each that may bring light gets
/// its part of three quarters: a sun outdoors must not leave a room's lamps without rays.
GLOAM_HD void root_probabilities(const LightTreeView& tree, Vec3f p, Vec3f n, double* roots) {
  constexpr double kUniformFraction = 0.75;
  double total = 0;
  int some = 0;
  for (uint32_t i = 0; i < LightTreeView::kRoots; ++i) {
    roots[i] = static_cast<double>(bound(tree.nodes[i], p, n));
    total += roots[i];
    some += roots[i] > 0 ? 1 : 0;
  }
  for (uint32_t i = 0; i < LightTreeView::kRoots; ++i) {
    if (roots[i] > 0)
      roots[i] = (1 - kUniformFraction) * roots[i] / total + kUniformFraction / some;
  }
}

/// Uniform in [0, 1), with u.x as its first 24 bits and a hash of both draws behind them: a million
/// lights use up all bits of one draw.
GLOAM_HD double lengthen(Vec2f u) {
  const auto bits = [](float x) { return static_cast<uint32_t>(x * 0x1p24f); };
  uint64_t h = bits(u.x) * 0x9E3779B97F4A7C15ull;  // SplitMix64's finalizer over both
  h ^= bits(u.y) * 0xD6E8FEB86659FD93ull;
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
  h ^= h >> 31;
  return static_cast<double>(bits(u.x)) * 0x1p-24 + static_cast<double>(h >> 36) * 0x1p-52;
}

/// Takes a light for the point p with the normal n (0: none) by the uniform number `pick`.
GLOAM_HD LightChoice choose(const LightTreeView& tree, Vec3f p, Vec3f n, double pick) {
  double roots[LightTreeView::kRoots];
  root_probabilities(tree, p, n, roots);
  uint32_t row = LightTreeView::kRoots;
  for (uint32_t i = 0; i < LightTreeView::kRoots; ++i) {
    if (!(roots[i] > 0)) continue;
    if (row < LightTreeView::kRoots) pick -= roots[row];
    row = i;
    if (pick < roots[i]) break;
  }
  if (row == LightTreeView::kRoots) return {};
  double probability = roots[row];
  pick /= probability;
  while ((tree.nodes[row].flags & LightNode::kLeaf) == 0) {
    row = tree.nodes[row].first;
    const double a = static_cast<double>(bound(tree.nodes[row], p, n));
    const double b = static_cast<double>(bound(tree.nodes[row + 1], p, n));
    if (!(a + b > 0)) return {};
    const double first = a / (a + b);
    if (pick < first) {
      pick /= first;
      probability *= first;
    } else {
      ++row;
      pick = (pick - first) / (1 - first);
      probability *= b / (a + b);
    }
  }
  return {tree.nodes[row].first, static_cast<float>(probability),
          clamp(static_cast<float>(pick), 0.0f, 0.9999999f)};
}

/// Probability with which choose() takes the light.
GLOAM_HD float probability(const LightTreeView& tree, uint32_t light, Vec3f p, Vec3f n) {
  uint32_t row = tree.leaf_of[light];
  double result = 1;
  while (row >= LightTreeView::kRoots) {
    const double mine = static_cast<double>(bound(tree.nodes[row], p, n));
    if (!(mine > 0)) return 0;
    result *= mine / (mine + static_cast<double>(bound(tree.nodes[row ^ 1u], p, n)));
    row = tree.nodes[row].parent;
  }
  double roots[LightTreeView::kRoots];
  root_probabilities(tree, p, n, roots);
  return static_cast<float>(result * roots[row]);
}

/// Whether the ray may meet something of the node before `tmax`.
GLOAM_HD bool may_meet(const LightNode& node, const Ray& ray, Vec3f inverse_d, float tmax) {
  if ((node.flags & LightNode::kShown) == 0) return false;
  if ((node.flags & LightNode::kFar) != 0) {
    return tmax >= 1e29f && fast_acos(-dot(ray.d, node.axis)) <= node.spread + kAngleSlack;
  }
  const Vec3f to = node.center - ray.o;
  float from = 0, until = tmax;
  for (int k = 0; k < 3; ++k) {
    // Outwards by more than rounding takes away; 0 x infinity leaves the interval as it is.
    const float reach = node.half[k] + 1e-5f * (fabsf(to[k]) + node.half[k]);
    const float a = (to[k] - reach) * inverse_d[k], b = (to[k] + reach) * inverse_d[k];
    from = max(min(a, b), from);
    until = min(max(a, b), until);
  }
  return from <= until;
}

/// Calls visit(light) for every lamp and sun that the ray may meet before `tmax`, and for lights
/// beside them.
template <class Visit>
GLOAM_HD void each_shown(const LightTreeView& tree, const Ray& ray, float tmax,
                         const Visit& visit) {
  const Vec3f inverse_d{1.0f / ray.d.x, 1.0f / ray.d.y, 1.0f / ray.d.z};
  for (uint32_t root = 0; root < LightTreeView::kRoots; ++root) {
    for (uint32_t row = root;;) {
      const LightNode& node = tree.nodes[row];
      if (may_meet(node, ray, inverse_d, tmax)) {
        if ((node.flags & LightNode::kLeaf) == 0) {
          row = node.first;
          continue;
        }
        visit(node.first);
      }
      while (row >= LightTreeView::kRoots && (row & 1u) != 0) row = tree.nodes[row].parent;
      if (row < LightTreeView::kRoots) break;
      ++row;
    }
  }
}

}  // namespace light_tree
}  // namespace gloam
