#pragma once
// Implementation of embree_scene.h with Embree.

#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "render/cpu/tracer/embree_api.h"
#include "render/cpu/tracer/embree_scene.h"
#include "render/kernel/surface/shapes.h"
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

/// A curved shape as Embree's callbacks see it: frame G in the frame of its
/// BVH.
struct ShapeGeometry {
  ShapeType shape;
  Vec3f size;
  Affine3f X_SG;
};

/// An instance or a deformable, and what Embree has of it.
struct MovingGeometry {
  RtcOwner<RTCGeometry> geometry;
  std::vector<Affine3f> poses = {};  ///< instances: at all keys; empty = none yet
  unsigned key_count = 0;            ///< deformables: of its buffers; 0 = none yet
};

class EmbreeBuild final : public EmbreeScene {
 public:
  explicit EmbreeBuild(RtcOwner<RTCDevice> device) : device_(std::move(device)) {}

  Status update(const RenderScene& scene) override;
  CpuTracer tracer(const RenderScene& scene) const override;
  CpuTracer static_tracer(const RenderScene& scene) const override;

 private:
  using ShapeKey = std::tuple<ShapeType, uint32_t, float, float, float>;

  void build(const RenderScene& scene);
  void build_fixed(const RenderScene& scene);
  void build_moving(const RenderScene& scene);
  void build_shapes(const RenderScene& scene);
  /// The BVH of its shape in its own frame; one that is new is to be committed.
  RTCScene shape_of(const RenderScene& scene, const InstanceView& in,
                    std::vector<RTCScene>* to_commit);
  RtcOwner<RTCGeometry> instance_of(RTCScene shape);
  void rebuild_mesh(const RenderScene& scene, uint32_t mesh);
  RtcOwner<RTCGeometry> mesh_geometry(const MeshView& mesh);
  RtcOwner<RTCGeometry> shape_geometry(ShapeType shape, Vec3f size, const Affine3f& X_SG);
  RtcOwner<RTCGeometry> box_geometry(Vec3f size, const Affine3f& X_SG);
  RtcOwner<RTCScene> new_scene();

  RtcOwner<RTCDevice> device_;
  RtcOwner<RTCScene> fixed_;  ///< geometry that never moves, in world coordinates; null = none
  std::map<ShapeKey, RtcOwner<RTCScene>>
      shapes_;                 ///< one BVH per shape that moves, or that many share
  RtcOwner<RTCScene> moving_;  ///< instances, deformables; null = none
  std::vector<MovingGeometry> moving_geometries_;
  /// Embree id -> instance: those of moving_, then the scanned solids, then
  /// those of fixed_.
  std::vector<uint32_t> rows_;
  ScanTable scanned_;
  std::optional<uint64_t> drawn_version_;                   ///< of the scene that is built
  std::vector<std::unique_ptr<ShapeGeometry>> shape_data_;  ///< Embree keeps pointers to them
};

}  // namespace gloam
