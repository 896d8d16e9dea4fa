#pragma once
// Height of static things, seen from above: nothing falls from the sky below it.

#include <memory>
#include <vector>

#include "base/device.h"
#include "base/vec.h"

namespace gloam {

struct RenderDescription;

/// Heights in square cells; open sky beyond them. Device-safe.
struct ShelterView {
  Vec2f low;            ///< corner [m]
  float per_metre = 0;  ///< 1 / edge of a cell
  int nx = 0, ny = 0;
  DeviceSpan<const float> height;  ///< [m], x fastest; -inf = nothing there

  /// Share of the four cells about p whose top is not above p by more than `tolerance` [m].
  GLOAM_HD float open_above(Vec3f p, float tolerance) const {
    if (nx == 0) return 1;
    const float x = (p.x - low.x) * per_metre - 0.5f, y = (p.y - low.y) * per_metre - 0.5f;
    if (!(x > -1 && y > -1 && x < static_cast<float>(nx) && y < static_cast<float>(ny))) return 1;
    const int i = static_cast<int>(floorf(x)), j = static_cast<int>(floorf(y));
    const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
    const auto open = [&](int a, int b) {
      if (a < 0 || b < 0 || a >= nx || b >= ny) return 1.0f;
      return height[static_cast<uint32_t>(b * nx + a)] <= p.z + tolerance ? 1.0f : 0.0f;
    };
    return (open(i, j) * (1 - fx) + open(i + 1, j) * fx) * (1 - fy) +
           (open(i, j + 1) * (1 - fx) + open(i + 1, j + 1) * fx) * fy;
  }
};

struct ShelterMap {
  Vec2f low;
  float cell = 0.1f;  ///< [m]
  float lowest = 0;   ///< height of the lowest static thing, ground included [m]
  int nx = 0, ny = 0;
  std::vector<float> height;  ///< as in ShelterView

  ShelterView view() const {
    return {low, 1 / cell, nx, ny, {height.data(), static_cast<uint32_t>(height.size())}};
  }
};

/// Map of the static instances that are shown, in cells of 0.1 m or more, at most 1024 along an
/// edge. `X_WB`: poses of all bodies.
std::shared_ptr<const ShelterMap> make_shelter_map(const RenderDescription& description,
                                                   const std::vector<Affine3f>& X_WB);

}  // namespace gloam
