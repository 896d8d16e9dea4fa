#pragma once
// Embree's traversal as the kernel wants it: one ray, lanes, or packets.

#include <embree3/rtcore.h>

#include "render/kernel/scene_view.h"

namespace gloam {

/// What the kernel traces with. Cheap to copy; valid until the scene's next update.
class EmbreeTracer {
 public:
  static constexpr int kPacket = 16;

  /// One ray: the closest hit, or with `any` just whether there is one.
  bool trace(const Ray& ray, bool any, RayHit* hit) const;
  /// The rays of the `active` lanes; returns those that hit something.
  bool closest(const Ray& ray, bool active, bool coherent, RayHit* hit) const;
  bool occluded(const Ray& ray, bool active) const;
  MaskLanes closest(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
                    RayHitOf<FloatLanes>* hit) const;
  MaskLanes occluded(const RayOf<FloatLanes>& ray, MaskLanes active) const;
  /// Up to kPacket rays of one kind at once; even incoherent ones are faster so.
  void trace_packet(const Ray* const* rays, int count, bool any, bool coherent, RayHit* hits,
                    bool* found) const;

  // Two scenes, one after the other: an instance around all that is static would cost every ray
  // more.
  RTCScene fixed = nullptr, moving = nullptr;  ///< either may be absent
  DeviceSpan<const uint32_t> rows;             ///< Embree id -> instance, those of `moving` first
  uint32_t first_fixed = 0;                    ///< id of the first of `fixed`
  DeviceSpan<const uint32_t> planes;           ///< rows of infinite planes
  DeviceSpan<const InstanceView> instances;

 private:
  void resolve(uint32_t instance_id, uint32_t geometry_id, float time, RayHit* hit) const;
};

}  // namespace gloam
