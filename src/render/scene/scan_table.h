#pragma once
// Instances that every ray is tested against one by one (render/kernel/trace/scan.h).

#include <vector>

#include "geometry/bvh/bvh_build.h"
#include "render/kernel/trace/scan.h"
#include "render/scene/render_scene.h"

namespace gloam {

inline BvhBox as_box(const Bounds& b) { return {b.low, b.high}; }

bool is_infinite_plane(const InstanceView& instance);
/// Drawn, in one place, of finite extent.
bool stands_still(const RenderScene& scene, size_t instance);
/// Bounds of an analytic shape in the world.
Bounds shape_bounds(ShapeType shape, Vec3f size, const Affine3f& X_WG);
/// Bounds wide enough to allow for rounding.
Bounds wider(const Bounds& bounds);

struct ScanTable {
  std::vector<uint32_t> planes;      ///< rows of infinite planes
  std::vector<ScannedSolid> solids;  ///< group by group
  std::vector<ScanGroup> groups;     ///< that of the largest solid first

  /// Takes all infinite planes, and of the solids that stand still the `most` largest: most rays
  /// end there. Those with less than `least_fraction` of the largest's surface are left out.
  static ScanTable choose(const RenderScene& scene, size_t most, float least_fraction);
  bool holds(size_t instance) const;
  ScanList list(const RenderScene& scene) const;
};

}  // namespace gloam
