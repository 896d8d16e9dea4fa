#pragma once
// Embree behind one face: acceleration structures of a RenderScene and the Tracer that the kernel
// is compiled with. Static geometry is one BVH, built once; each moving geom is an instance of the
// BVH of its shape with one or two motion keys. Infinite planes stay outside, in a short list.

#include <embree3/rtcore.h>

#include <map>
#include <memory>
#include <vector>

#include "render/kernel/shapes.h"
#include "render/scene/render_scene.h"

namespace gloam {

/// Releases Embree handles.
struct RtcRelease {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
  void operator()(RTCGeometry g) const { rtcReleaseGeometry(g); }
};
template <class Handle>
using RtcOwner = std::unique_ptr<std::remove_pointer_t<Handle>, RtcRelease>;

/// A curved shape as Embree's callbacks see it: frame G in the frame of its BVH.
struct ShapeGeometry {
  ShapeType shape;
  Vec3f size;
  Affine3f X_SG;
};

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
  /// Nearest infinite plane before *tmax, which moves there; -1 = none.
  int hit_planes(const Ray& ray, float* tmax) const;
  /// The same in lanes: row + 1, 0 = none.
  UintLanes hit_planes(const RayOf<FloatLanes>& ray, FloatLanes* tmax) const;
  void resolve(uint32_t instance_id, uint32_t geometry_id, float time, RayHit* hit) const;
};

class EmbreeScene {
 public:
  /// Errors: Embree cannot start, out of memory.
  static Result<std::unique_ptr<EmbreeScene>> make();

  /// Builds what is missing, moves what moves. `scene` must be updated before and stay the same
  /// object.
  Status update(const RenderScene& scene);
  EmbreeTracer tracer(const RenderScene& scene) const;
  /// Of what never moves alone, without infinite planes; no scene = nothing.
  EmbreeTracer static_tracer(const RenderScene& scene) const;

 private:
  using ShapeKey = std::tuple<ShapeType, uint32_t, float, float, float>;

  EmbreeScene() = default;
  void build(const RenderScene& scene);
  void build_fixed(const RenderScene& scene);
  void build_moving(const RenderScene& scene);
  void build_shapes(const RenderScene& scene);
  void rebuild_mesh(const RenderScene& scene, uint32_t mesh);
  RtcOwner<RTCGeometry> mesh_geometry(const MeshView& mesh);
  RtcOwner<RTCGeometry> shape_geometry(ShapeType shape, Vec3f size, const Affine3f& X_SG);
  RtcOwner<RTCGeometry> box_geometry(Vec3f size, const Affine3f& X_SG);
  RtcOwner<RTCScene> new_scene();

  RtcOwner<RTCDevice> device_;
  RtcOwner<RTCScene> fixed_;  ///< geometry that never moves, in world coordinates; null = none
  std::map<ShapeKey, RtcOwner<RTCScene>> shapes_;  ///< one BVH per distinct moving shape
  RtcOwner<RTCScene> moving_;                      ///< instances, deformables; null = none
  std::vector<RtcOwner<RTCGeometry>> moving_geometries_;
  std::vector<uint32_t> rows_;  ///< Embree id -> instance: those of moving_, then those of fixed_
  std::vector<uint32_t> planes_;
  bool built_ = false;
  uint64_t drawn_version_ = 0;                              ///< of the scene that is built
  std::vector<std::unique_ptr<ShapeGeometry>> shape_data_;  ///< Embree keeps pointers to them
  std::vector<std::unique_ptr<std::vector<Vec3f>>> vertex_data_;
};

}  // namespace gloam
