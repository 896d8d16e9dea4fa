#pragma once
// Solids that every ray is tested against one by one, in lanes: infinite planes, and the largest
// simple solids that stand still. For a few solids the test takes a fraction of the time of a BVH,
// and rooms are made of such solids. Device-safe.

#include "render/kernel/surface/surface.h"

namespace gloam {

struct Bounds {
  Vec3f low, high;  ///< world [m]
};

struct ScannedSolid {
  Bounds bounds;
  bool is_bounds = false;  ///< a box along the axes of the world: `bounds` is all of it
  uint32_t row = 0;        ///< of SceneView::instances
};

/// Solids close together: what misses their bounds misses all of them.
struct ScanGroup {
  Bounds bounds;
  uint32_t first = 0, count = 0;  ///< of ScanList::solids
};

struct ScanList {
  DeviceSpan<const uint32_t> planes;  ///< rows of infinite planes, which may move
  DeviceSpan<const ScannedSolid> solids;
  DeviceSpan<const ScanGroup> groups;  ///< of all solids; for rays in lanes
  DeviceSpan<const InstanceView> instances;
};

namespace scans {

/// Distances at which a ray enters and leaves a box; it misses the box if it leaves before it
/// enters. `inverse`: one over the ray's direction, component by component.
template <class F>
GLOAM_HD void cross_box(Vec3Of<F> low, Vec3Of<F> high, Vec3Of<F> o, Vec3Of<F> inverse, F* enter,
                        F* leave) {
  *enter = -1e30f;
  *leave = 1e30f;
  for (int k = 0; k < 3; ++k) {
    const F a = (low[k] - o[k]) * inverse[k], b = (high[k] - o[k]) * inverse[k];
    // A ray within a face's plane makes 0 / 0; in this order it counts as no bound.
    *enter = max(min(a, b), *enter);
    *leave = min(max(a, b), *leave);
  }
}

template <class F>
GLOAM_HD Vec3Of<F> inverse_of(Vec3Of<F> d) {
  return {1.0f / d.x, 1.0f / d.y, 1.0f / d.z};
}

/// Lanes whose ray may meet the box before tmax. `inverse` as above.
template <class F>
GLOAM_HD MaskOf<F> may_meet(const Bounds& box, Vec3Of<F> o, Vec3Of<F> inverse, F tmax, F* enter,
                            F* leave) {
  cross_box(in_all_lanes<F>(box.low), in_all_lanes<F>(box.high), o, inverse, enter, leave);
  return (*enter <= *leave) & (*leave > 0.0f) & (*enter < tmax);
}

/// Lanes that hit the plane before tmax, and where.
template <class F>
GLOAM_HD MaskOf<F> hit_plane(const InstanceView& plane, const RayOf<F>& ray, F tmax, F* t) {
  AffineOf<F> X_WG = pose_in_all_lanes<F>(plane.X_WG);
  if (!kPlainScenes && plane.moving) {
    each_lane(MaskOf<F>(true), [&](int i) {
      Affine3f between;
      set_lane(&X_WG, i, pose_at(plane, lane(ray.time, i), &between));
    });
  }
  *t = shapes::hit_plane(plane.size, to_frame(X_WG, ray.o - X_WG.p), to_frame(X_WG, ray.d), F(0.0f),
                         tmax);
  return *t > 0.0f;
}

/// Lanes of `active` whose ray hits the solid before tmax, and where. `inverse` as above, in the
/// world.
template <class F>
GLOAM_HD MaskOf<F> hit_solid(const ScannedSolid& solid, const InstanceView& instance,
                             const RayOf<F>& ray, Vec3Of<F> inverse, MaskOf<F> active, F tmax,
                             F* t) {
  F enter, leave;
  MaskOf<F> hit = active & may_meet(solid.bounds, ray.o, inverse, tmax, &enter, &leave);
  if (!solid.is_bounds) {
    if (!any(hit)) return hit;
    const AffineOf<F> X_WG = pose_in_all_lanes<F>(instance.X_WG);
    const Vec3Of<F> o_G = to_frame(X_WG, ray.o - X_WG.p), d_G = to_frame(X_WG, ray.d);
    if (instance.shape != ShapeType::kBox) {
      each_lane(hit, [&](int i) {
        const float found = intersect_shape(instance.shape, instance.size, lane(o_G, i),
                                            lane(d_G, i), 0.0f, lane(tmax, i));
        set_lane(t, i, found);
        set_lane(&hit, i, found > 0);
      });
      return hit;
    }
    const Vec3Of<F> size = in_all_lanes<F>(instance.size);
    cross_box(-size, size, o_G, inverse_of(d_G), &enter, &leave);
    hit = hit & (enter <= leave) & (leave > 0.0f);
  }
  *t = select(enter > 0.0f, enter, leave);  // from within
  return hit & (*t < tmax);
}

}  // namespace scans

/// Lanes whose ray may meet the box before tmax.
template <class F>
GLOAM_HD MaskOf<F> may_meet(const Bounds& box, const RayOf<F>& ray, F tmax) {
  F enter, leave;
  return scans::may_meet(box, ray.o, scans::inverse_of(ray.d), tmax, &enter, &leave);
}

/// Row + 1 of the nearest thing of the list that the rays of the `active` lanes hit before *tmax,
/// which moves there; 0 = none. `any_hit`: any will do.
template <class F>
GLOAM_HD UintOf<F> scan(const ScanList& list, const RayOf<F>& ray, MaskOf<F> active, bool any_hit,
                        F* tmax) {
  UintOf<F> nearest = 0u;
  const auto take = [&](MaskOf<F> hit, F t, uint32_t row) {
    if (!any(hit)) return;
    *tmax = select(hit, t, *tmax);
    nearest = select(hit, UintOf<F>(row + 1), nearest);
    if (any_hit) active = active & !hit;
  };
  F t = 0.0f;
  for (uint32_t i = 0; i < list.planes.size; ++i) {
    const uint32_t row = list.planes[i];
    const MaskOf<F> hit = active & scans::hit_plane(list.instances[row], ray, *tmax, &t);
    take(hit, t, row);
  }
  const Vec3Of<F> inverse = scans::inverse_of(ray.d);
  const auto test = [&](uint32_t first, uint32_t end) {
    for (uint32_t i = first; i < end && any(active); ++i) {
      const ScannedSolid& solid = list.solids[i];
      const MaskOf<F> hit =
          scans::hit_solid(solid, list.instances[solid.row], ray, inverse, active, *tmax, &t);
      take(hit, t, solid.row);
    }
  };
  if constexpr (Lanes<F>::kCount == 1) {
    test(0, list.solids.size);
  } else {
    for (uint32_t i = 0; i < list.groups.size && any(active); ++i) {
      const ScanGroup& group = list.groups[i];
      F enter, leave;
      const bool worth =
          group.count == 1 ||
          any(active & scans::may_meet(group.bounds, ray.o, inverse, *tmax, &enter, &leave));
      if (worth) test(group.first, group.first + group.count);
    }
  }
  return nearest;
}

}  // namespace gloam
