#pragma once
// Builds and refits the trees of geometry/bvh/bvh.h. The same boxes give the same tree, whatever
// the number of threads.

#include <vector>

#include "geometry/bvh/bvh.h"

namespace gloam {

struct BvhBox {
  Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};

  void add(Vec3f p) {
    // In this order what is not a number counts as nothing.
    low = {min(p.x, low.x), min(p.y, low.y), min(p.z, low.z)};
    high = {max(p.x, high.x), max(p.y, high.y), max(p.z, high.z)};
  }
  void add(const BvhBox& b) {
    low = {min(b.low.x, low.x), min(b.low.y, low.y), min(b.low.z, low.z)};
    high = {max(b.high.x, high.x), max(b.high.y, high.y), max(b.high.z, high.z)};
  }
  /// Half of the surface; zero of an empty box.
  float area() const {
    const Vec3f e = high - low;
    return e.x < 0 ? 0.0f : e.x * e.y + e.y * e.z + e.z * e.x;
  }
};

/// A tree over boxes. Leaves are refs to items of `order`, as if they were triangles.
struct BvhTree {
  std::vector<BvhNode> nodes;  ///< parents before their children
  BvhRef root = bvh::kNothing;
  std::vector<uint32_t> order;  ///< box of each item
};

struct BvhBuild {
  int most_in_leaf = 4;
  int depth = bvh::kMeshDepth;
};

/// Binned surface area heuristic (Wald 2007). Boxes that are not finite are left out.
BvhTree build_bvh(const std::vector<BvhBox>& boxes, const BvhBuild& options);

/// The same tree over boxes that have moved. Returns the expected number of boxes that a ray
/// tests, in units of the root's area: above what it was after the build, a new tree is due.
float refit_bvh(const std::vector<BvhBox>& boxes, BvhTree* tree);

}  // namespace gloam
