#pragma once
// Our own bounding volume hierarchy as both sides read it: binary nodes that hold the boxes of
// their two children, triangles in the order of the leaves, and instances above them. Device-safe.

#include "base/vec.h"

namespace gloam {

/// A node, some triangles, or an instance: two bits say which.
using BvhRef = uint32_t;

namespace bvh {

inline constexpr BvhRef kTriangles = 1u << 30, kInstance = 2u << 30, kNothing = 3u << 30;
inline constexpr BvhRef kKind = 3u << 30;
inline constexpr int kMostTriangles = 8;  ///< triangles of a leaf
/// Nodes above a leaf, at most: of one mesh, and of the instances. Together they bound the stack.
inline constexpr int kMeshDepth = 40, kTopDepth = 22;

/// `count` triangles from `first` on.
GLOAM_HD BvhRef triangles_ref(uint32_t first, uint32_t count) {
  return kTriangles | (first << 3) | (count - 1);
}
GLOAM_HD uint32_t first_triangle(BvhRef ref) { return (ref & ~kKind) >> 3; }
GLOAM_HD uint32_t triangle_count(BvhRef ref) { return (ref & 7u) + 1; }

}  // namespace bvh

/// Node with two children: their boxes as centre and half size, and references to their content.
struct alignas(64) BvhNode {
  Vec3f center[2], half[2];
  BvhRef child[2] = {bvh::kNothing, bvh::kNothing};
  uint32_t unused[2] = {};
};
static_assert(sizeof(BvhNode) == 64);

struct alignas(16) BvhTriangle {
  Vec3f a;
  uint32_t primitive = 0;  ///< in its mesh
  Vec3f b;
  uint32_t unused0 = 0;
  Vec3f c;
  uint32_t unused1 = 0;
};
static_assert(sizeof(BvhTriangle) == 48);

/// A mesh or one solid in its place, in frame G.
struct alignas(16) BvhInstance {
  Vec3f row[3];         ///< rows of R_GW
  Vec3f shift;          ///< p_G = rows p_W + shift
  BvhRef root = 0;      ///< root of a mesh; bvh::kNothing = a solid
  uint32_t id = 0;      ///< id that a hit reports
  int32_t motion = -1;  ///< first row of BvhView::motion; -1 = stands still
  /// Step from the triangles of one key to those of the next, for a mesh that changes its form; 0 =
  /// it does not
  uint32_t key_step : 31 = 0;
  uint32_t is_clear : 1 = 0;  ///< may let light straight through
};
static_assert(sizeof(BvhInstance) == 64);

struct BvhView {
  const BvhNode* nodes = nullptr;
  const BvhTriangle* triangles = nullptr;
  const BvhInstance* instances = nullptr;
  /// X_WG of the instances that move, key_count of each: evenly over times 0 … 1, linear in
  /// between.
  const Affine3f* motion = nullptr;
  uint32_t key_count = 0;
  BvhRef root = bvh::kNothing;
};

}  // namespace gloam
