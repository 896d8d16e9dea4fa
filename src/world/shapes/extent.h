#pragma once
// Axis-aligned boxes that grow, in the world's frame.

#include <algorithm>
#include <limits>
#include <span>

#include "gloam/scene/environment.h"

namespace gloam {

struct Extent {
  static constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3 low{kInf, kInf, kInf}, high{-kInf, -kInf, -kInf};  ///< [m]

  void add(const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  Vec3 middle() const { return {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2}; }
};

/// All of the regions, and `beyond` [m] their walls, floors and ceilings; of none an empty one.
inline Extent extent_of(std::span<const Region> regions, double beyond) {
  Extent extent;
  for (const Region& region : regions) {
    extent.add({region.low.x - beyond, region.low.y - beyond, region.low.z - beyond});
    extent.add({region.high.x + beyond, region.high.y + beyond, region.high.z + beyond});
  }
  return extent;
}

}  // namespace gloam
