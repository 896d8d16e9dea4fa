#pragma once
// The tree over many lights as the kernel reads it: render/scene/light_tree_table.h builds it,
// render/kernel/light/light_tree.h goes through it. Device-safe.

#include "base/vec.h"

namespace gloam {

/// Bounds of a set of lights: where they are, which way they shine, and how strongly.
struct LightNode {
  static constexpr uint32_t kLeaf = 1;   ///< one light
  static constexpr uint32_t kFar = 2;    ///< directional lights: center and half mean nothing
  static constexpr uint32_t kShown = 4;  ///< holds a lamp or sun that a ray can meet
  static constexpr uint32_t kNone = ~0u;

  Vec3f center, half;  ///< of the box that holds them [m]
  Vec3f axis;          ///< of the cone of their axes, unit
  float spread = kPi;  ///< half angle of that cone [rad]
  float falloff = 0;   ///< angle from its axis within which a light of the set shines [rad]
  float power =
      0;  ///< luminous intensity, of far ones illuminance, as a fraction of all; 0 = empty
  uint32_t first = kNone;   ///< row of nodes: its two children's first; of a leaf: row of lights
  uint32_t parent = kNone;  ///< row of nodes; kNone: a root
  uint32_t flags = 0;
};

/// A binary tree with one light in each leaf, in three parts.
struct LightTreeView {
  static constexpr uint32_t kNear = 0, kFar = 1, kCarried = 2;  ///< roots; kCarried: headlights
  static constexpr uint32_t kRoots = 3;
  /// The roots, an unused one, then siblings side by side, from an even row on.
  DeviceSpan<const LightNode> nodes;
  DeviceSpan<const uint32_t> leaf_of;  ///< row of nodes, by light
};

}  // namespace gloam
