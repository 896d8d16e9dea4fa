#pragma once
// Trees of large meshes, kept so that a second start does not build them again.

#include "geometry/bvh/bvh_build.h"

namespace gloam {

/// From as many boxes on a tree is kept: below, building takes no longer than 0.1 s.
inline constexpr size_t kBvhWorthCaching = 200'000;

/// Result of build_bvh, out of the cache if it holds the tree of these boxes.
BvhTree build_bvh_cached(const std::vector<BvhBox>& boxes, const BvhBuild& options);

}  // namespace gloam
