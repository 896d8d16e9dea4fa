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
  bool trace(const Ray& ray, bool any, RayHit* hit) const {
    float tmax = ray.tmax;
    int plane = -1;
    for (uint32_t i = 0; i < planes.size; ++i) {
      const InstanceView& instance = instances[planes[i]];
      const Affine3f X_WG = pose_at(instance, ray.time);
      const Vec3f o = ray.o - X_WG.p;
      const float t = intersect_shape(
          ShapeType::kPlane, instance.size, {dot(o, X_WG.x), dot(o, X_WG.y), dot(o, X_WG.z)},
          {dot(ray.d, X_WG.x), dot(ray.d, X_WG.y), dot(ray.d, X_WG.z)}, 0.0f, tmax);
      if (t > 0) {
        if (any) return true;
        tmax = t;
        plane = static_cast<int>(planes[i]);
      }
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    query.ray = {ray.o.x, ray.o.y,  ray.o.z, 0.0f, ray.d.x, ray.d.y,
                 ray.d.z, ray.time, tmax,    ~0u,  0,       0};
    if (any) {
      rtcOccluded1(root, &context, &query.ray);
      return query.ray.tfar < 0;
    }
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(root, &context, &query);
    const RTCHit& h = query.hit;
    if (h.geomID == RTC_INVALID_GEOMETRY_ID) {
      if (plane < 0) return false;
      *hit = {.t = tmax, .instance = static_cast<uint32_t>(plane)};
      return true;
    }
    hit->t = query.ray.tfar;
    hit->primitive = h.primID;
    hit->u = h.u;
    hit->v = h.v;
    hit->normal = {h.Ng_x, h.Ng_y, h.Ng_z};
    const uint32_t top = h.instID[0];
    if (top == RTC_INVALID_GEOMETRY_ID) {
      hit->instance = root_rows[h.geomID];
    } else if (top == static_id) {
      hit->instance = static_rows[h.geomID];
    } else {
      hit->instance = root_rows[top];
      const InstanceView& instance = instances[hit->instance];
      Affine3f between;
      hit->normal = transform_vector(pose_at(instance, ray.time, &between), hit->normal);
    }
    return true;
  }

  RTCScene root = nullptr;
  uint32_t static_id = RTC_INVALID_GEOMETRY_ID;
  DeviceSpan<const uint32_t> root_rows, static_rows;  ///< Embree id -> instance
  DeviceSpan<const uint32_t> planes;                  ///< rows of infinite planes
  DeviceSpan<const InstanceView> instances;
};

class EmbreeScene {
 public:
  /// Errors: Embree cannot start, out of memory.
  static Result<std::unique_ptr<EmbreeScene>> make();

  /// Builds what is missing, moves what moves. `scene` must be updated before and stay the same
  /// object.
  Status update(const RenderScene& scene);
  EmbreeTracer tracer(const RenderScene& scene) const;

 private:
  using ShapeKey = std::tuple<ShapeType, uint32_t, float, float, float>;

  EmbreeScene() = default;
  void build_static(const RenderScene& scene);
  void build_shapes(const RenderScene& scene);
  void make_root(const RenderScene& scene);
  RtcOwner<RTCGeometry> mesh_geometry(const MeshView& mesh);
  RtcOwner<RTCGeometry> shape_geometry(ShapeType shape, Vec3f size, const Affine3f& X_SG);
  RtcOwner<RTCGeometry> box_geometry(Vec3f size, const Affine3f& X_SG);
  RtcOwner<RTCScene> new_scene();

  RtcOwner<RTCDevice> device_;
  RtcOwner<RTCScene> static_;  ///< geometry that never moves, in world coordinates
  std::map<ShapeKey, RtcOwner<RTCScene>> shapes_;  ///< one BVH per distinct moving shape
  RtcOwner<RTCScene> root_;                        ///< instances; null when nothing moves
  std::vector<RtcOwner<RTCGeometry>> root_geometries_;
  uint32_t static_id_ = RTC_INVALID_GEOMETRY_ID;
  std::vector<uint32_t> static_rows_, root_rows_, planes_;
  std::vector<std::unique_ptr<ShapeGeometry>> shape_data_;  ///< Embree keeps pointers to them
  std::vector<std::unique_ptr<std::vector<Vec3f>>> vertex_data_;
};

}  // namespace gloam
