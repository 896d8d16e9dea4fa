#pragma once
// Embree behind one face: acceleration structures of a RenderScene and the Tracer that the kernel
// is compiled with. Static geometry is one BVH, built once; each moving geom is an instance of the
// BVH of its shape with one or two motion keys. Infinite planes and the largest simple solids that
// stand still stay outside, in a short list.

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "render/cpu/embree_tracer.h"
#include "render/kernel/shapes.h"
#include "render/scene/scan_table.h"

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
  /// Embree id -> instance: those of moving_, then the scanned solids, then those of fixed_.
  std::vector<uint32_t> rows_;
  ScanTable scanned_;
  std::optional<uint64_t> drawn_version_;                   ///< of the scene that is built
  std::vector<std::unique_ptr<ShapeGeometry>> shape_data_;  ///< Embree keeps pointers to them
};

}  // namespace gloam
