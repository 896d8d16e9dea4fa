#pragma once
// Tracer of the kernel on the CPU: a short list that is scanned, and Embree's traversal of the
// rest; or our own BVH for all of it.

#include <optional>

#include "render/kernel/trace/bvh_tracer.h"

struct RTCSceneTy;  // Embree's RTCScene points to it

namespace gloam {

struct PictureClip;  // render/cpu/tracer/picture_clip.h

/// A scene of Embree's and what it lies in.
struct EmbreePart {
  RTCSceneTy* scene = nullptr;  ///< null = nothing
  Bounds bounds;                ///< a little wider than the scene
};

/// Cheap to copy; valid until the scene's next update.
class CpuTracer {
 public:
  static constexpr int kPacket = kLaneCount;

  /// One ray: the closest hit, or with `any` just whether there is one.
  bool trace(const Ray& ray, bool any, RayHit* hit) const;
  /// The rays of the `active` lanes; returns those that hit something.
  bool closest(const Ray& ray, bool active, bool coherent, RayHit* hit) const;
  bool occluded(const Ray& ray, bool active) const;
  MaskLanes closest(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
                    RayHitOf<FloatLanes>* hit) const;
  MaskLanes occluded(const RayOf<FloatLanes>& ray, MaskLanes active) const;
  /// Traces up to kPacket rays of one kind at once.
  void trace_packet(const Ray* const* rays, int count, bool any, bool coherent, RayHit* hits,
                    bool* found) const;

  /// Tracers of only the instances that never move, and of only the others; without a clip. Not for
  /// a tracer of our own BVH.
  CpuTracer fixed_part() const;
  CpuTracer moving_part() const;

  // Two scenes, one after the other: an instance around all that is static
  // would cost every ray more.
  EmbreePart fixed, moving;
  DeviceSpan<const uint32_t> rows;  ///< Embree id -> instance, what moves first
  uint32_t first_still = 0;         ///< id of the first that never moves
  ScanList scanned;
  /// Tracer of our own BVH, which then answers for all of the above.
  std::optional<BvhTracer> own;
  /// Clip of the camera whose picture is traced: its rays pass the surfaces that it does not see.
  /// Null = none.
  const PictureClip* clip = nullptr;

 private:
  MaskLanes closest_of_all(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
                           RayHitOf<FloatLanes>* hit) const;
  MaskLanes closest_in_view(const RayOf<FloatLanes>& ray, MaskLanes active, MaskLanes first,
                            bool coherent, RayHitOf<FloatLanes>* hit) const;
  bool by_embree(const Ray& ray, bool any, RayHit* hit) const;
  MaskLanes closest_by_embree(const RayOf<FloatLanes>& ray, MaskLanes active, bool coherent,
                              RayHitOf<FloatLanes>* hit) const;
  MaskLanes occluded_by_embree(const RayOf<FloatLanes>& ray, MaskLanes active) const;
  void resolve(uint32_t instance_id, uint32_t geometry_id, float time, RayHit* hit) const;
};

}  // namespace gloam
