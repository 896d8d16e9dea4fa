#include "render/cpu/embree_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/log.h"
#include "base/parallel.h"

namespace gloam {
namespace {

bool is_mesh(ShapeType shape) {
  return shape == ShapeType::kMesh || shape == ShapeType::kDeformable;
}
bool is_infinite_plane(const InstanceView& instance) {
  return instance.shape == ShapeType::kPlane && (instance.size.x <= 0 || instance.size.y <= 0);
}

Vec3f to_shape(const Affine3f& X_SG, Vec3f v) {  // rigid
  return {dot(v, X_SG.x), dot(v, X_SG.y), dot(v, X_SG.z)};
}

float hit_distance(const ShapeGeometry& g, const RTCRay& ray) {
  const Vec3f o = Vec3f{ray.org_x, ray.org_y, ray.org_z} - g.X_SG.p;
  return intersect_shape(g.shape, g.size, to_shape(g.X_SG, o),
                         to_shape(g.X_SG, {ray.dir_x, ray.dir_y, ray.dir_z}), ray.tnear, ray.tfar);
}

void shape_bounds(const RTCBoundsFunctionArguments* args) {
  const ShapeGeometry& g = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
  Vec3f h = shape_half_size(g.shape, g.size);
  if (g.shape == ShapeType::kCapsule) h.z += g.size.x;
  if (g.shape == ShapeType::kPlane) h.z = 0;
  const Affine3f& X = g.X_SG;
  const auto reach = [&](float x, float y, float z) {
    return (fabsf(x) * h.x + fabsf(y) * h.y + fabsf(z) * h.z) * 1.00001f + 1e-6f;
  };
  const Vec3f r{reach(X.x.x, X.y.x, X.z.x), reach(X.x.y, X.y.y, X.z.y), reach(X.x.z, X.y.z, X.z.z)};
  *args->bounds_o = {X.p.x - r.x, X.p.y - r.y, X.p.z - r.z, 0,
                     X.p.x + r.x, X.p.y + r.y, X.p.z + r.z, 0};
}

// Only single rays are traced: N = 1.
void shape_intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  const ShapeGeometry& g = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
  RTCRayHit* query = reinterpret_cast<RTCRayHit*>(args->rayhit);
  const float t = hit_distance(g, query->ray);
  if (!(t > 0)) return;
  query->ray.tfar = t;
  query->hit.u = query->hit.v = 0;
  query->hit.Ng_x = query->hit.Ng_y = query->hit.Ng_z = 0;
  query->hit.geomID = args->geomID;
  query->hit.primID = 0;
  query->hit.instID[0] = args->context->instID[0];
}

void shape_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  const ShapeGeometry& g = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
  RTCRay* ray = reinterpret_cast<RTCRay*>(args->ray);
  if (hit_distance(g, *ray) > 0) ray->tfar = -INFINITY;
}

void set_transform(RTCGeometry geometry, unsigned key, const Affine3f& X) {
  const float columns[12] = {X.x.x, X.x.y, X.x.z, X.y.x, X.y.y, X.y.z,
                             X.z.x, X.z.y, X.z.z, X.p.x, X.p.y, X.p.z};
  rtcSetGeometryTransform(geometry, key, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
}

// Embree may read 16 bytes at the last vertex of a shared buffer: buffers it owns are padded.
void set_vertices(RTCGeometry geometry, unsigned key, const Vec3f* vertices, size_t count) {
  void* out = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key, RTC_FORMAT_FLOAT3,
                                      sizeof(Vec3f), count);
  if (out != nullptr) std::memcpy(out, vertices, count * sizeof(Vec3f));
}
void set_indices(RTCGeometry geometry, const uint32_t* indices, size_t triangles) {
  void* out = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                      3 * sizeof(uint32_t), triangles);
  if (out != nullptr) std::memcpy(out, indices, triangles * 3 * sizeof(uint32_t));
}

}  // namespace

Result<std::unique_ptr<EmbreeScene>> EmbreeScene::make() {
  std::unique_ptr<EmbreeScene> scene(new EmbreeScene);
  scene->device_.reset(rtcNewDevice(nullptr));
  if (scene->device_ == nullptr) {
    return Error{ErrorKind::kUnsupported,
                 fmt::format("Embree does not start (error {})",
                             static_cast<int>(rtcGetDeviceError(nullptr)))};
  }
  return scene;
}

RtcOwner<RTCScene> EmbreeScene::new_scene() {
  RtcOwner<RTCScene> scene(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

RtcOwner<RTCGeometry> EmbreeScene::mesh_geometry(const MeshView& mesh) {
  RtcOwner<RTCGeometry> geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  set_vertices(geometry.get(), 0, mesh.positions.data, mesh.positions.size);
  set_indices(geometry.get(), mesh.indices.data, mesh.indices.size / 3);
  return geometry;
}

// Boxes are triangles to Embree: its leaves test four of them faster than one callback.
RtcOwner<RTCGeometry> EmbreeScene::box_geometry(Vec3f size, const Affine3f& X_SG) {
  RtcOwner<RTCGeometry> geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  Vec3f corner[8];
  for (int i = 0; i < 8; ++i) {
    corner[i] =
        transform_point(X_SG, {(i & 1) != 0 ? size.x : -size.x, (i & 2) != 0 ? size.y : -size.y,
                               (i & 4) != 0 ? size.z : -size.z});
  }
  static constexpr uint32_t kTriangles[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                              2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  set_vertices(geometry.get(), 0, corner, 8);
  set_indices(geometry.get(), kTriangles, 12);
  return geometry;
}

RtcOwner<RTCGeometry> EmbreeScene::shape_geometry(ShapeType shape, Vec3f size,
                                                  const Affine3f& X_SG) {
  if (shape == ShapeType::kBox) return box_geometry(size, X_SG);
  RtcOwner<RTCGeometry> geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
  shape_data_.push_back(std::make_unique<ShapeGeometry>(ShapeGeometry{shape, size, X_SG}));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), 1);
  rtcSetGeometryUserData(geometry.get(), shape_data_.back().get());
  rtcSetGeometryBoundsFunction(geometry.get(), shape_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), shape_intersect);
  rtcSetGeometryOccludedFunction(geometry.get(), shape_occluded);
  return geometry;
}

void EmbreeScene::build_static(const RenderScene& scene) {
  static_ = new_scene();
  const std::vector<InstanceView>& instances = scene.instances();
  for (size_t i = 0; i < instances.size(); ++i) {
    const InstanceView& in = instances[i];
    if (!scene.description().instances[i].is_static || in.shape == ShapeType::kDeformable ||
        is_infinite_plane(in) || !scene.is_drawn(i)) {
      continue;
    }
    RtcOwner<RTCGeometry> geometry;
    if (is_mesh(in.shape)) {
      const MeshView& mesh = scene.meshes()[in.mesh];
      std::vector<Vec3f> world(mesh.positions.size);
      for (uint32_t v = 0; v < mesh.positions.size; ++v) {
        world[v] = transform_point(in.X_WG, mesh.positions[v]);
      }
      MeshView baked = mesh;
      baked.positions = {world.data(), mesh.positions.size};
      geometry = mesh_geometry(baked);
    } else {
      geometry = shape_geometry(in.shape, in.size, in.X_WG);
    }
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(static_.get(), geometry.get(),
                          static_cast<unsigned>(static_rows_.size()));
    static_rows_.push_back(static_cast<uint32_t>(i));
  }
  rtcCommitScene(static_.get());
}

void EmbreeScene::build_shapes(const RenderScene& scene) {
  std::vector<RTCScene> to_commit;
  const std::vector<InstanceView>& instances = scene.instances();
  for (size_t i = 0; i < instances.size(); ++i) {
    const InstanceView& in = instances[i];
    if (scene.description().instances[i].is_static || in.shape == ShapeType::kDeformable ||
        is_infinite_plane(in) || !scene.is_drawn(i)) {
      continue;
    }
    const ShapeKey key = is_mesh(in.shape) ? ShapeKey{in.shape, in.mesh, 0, 0, 0}
                                           : ShapeKey{in.shape, 0, in.size.x, in.size.y, in.size.z};
    RtcOwner<RTCScene>& shape = shapes_[key];
    if (shape == nullptr) {
      shape = new_scene();
      RtcOwner<RTCGeometry> geometry = is_mesh(in.shape) ? mesh_geometry(scene.meshes()[in.mesh])
                                                         : shape_geometry(in.shape, in.size, {});
      rtcCommitGeometry(geometry.get());
      rtcAttachGeometryByID(shape.get(), geometry.get(), 0);
      to_commit.push_back(shape.get());
    }
    RtcOwner<RTCGeometry> instance(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(instance.get(), shape.get());
    rtcAttachGeometryByID(root_.get(), instance.get(), static_cast<unsigned>(root_rows_.size()));
    root_rows_.push_back(static_cast<uint32_t>(i));
    root_geometries_.push_back(std::move(instance));
  }
  parallel_for("shape BVHs", static_cast<int64_t>(to_commit.size()),
               [&](int64_t i) { rtcCommitScene(to_commit[i]); });
}

void EmbreeScene::make_root(const RenderScene& scene) {
  const std::vector<InstanceView>& instances = scene.instances();
  for (size_t i = 0; i < instances.size(); ++i) {
    if (is_infinite_plane(instances[i]) && scene.is_drawn(i)) {
      planes_.push_back(static_cast<uint32_t>(i));
    }
  }
  build_static(scene);
  root_ = new_scene();
  rtcSetSceneFlags(root_.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
  build_shapes(scene);
  for (size_t i = 0; i < instances.size(); ++i) {
    if (instances[i].shape != ShapeType::kDeformable || !scene.is_drawn(i)) continue;
    RtcOwner<RTCGeometry> geometry = mesh_geometry(scene.meshes()[instances[i].mesh]);
    rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_REFIT);
    rtcAttachGeometryByID(root_.get(), geometry.get(), static_cast<unsigned>(root_rows_.size()));
    root_rows_.push_back(static_cast<uint32_t>(i));
    root_geometries_.push_back(std::move(geometry));
  }
  if (root_rows_.empty() || static_rows_.empty()) return;
  RtcOwner<RTCGeometry> instance(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(instance.get(), static_.get());
  set_transform(instance.get(), 0, {});
  rtcCommitGeometry(instance.get());
  static_id_ = static_cast<uint32_t>(root_rows_.size());
  rtcAttachGeometryByID(root_.get(), instance.get(), static_id_);
}

Status EmbreeScene::update(const RenderScene& scene) {
  if (root_ == nullptr) make_root(scene);
  for (size_t g = 0; g < root_geometries_.size(); ++g) {
    const RTCGeometry geometry = root_geometries_[g].get();
    const InstanceView& in = scene.instances()[root_rows_[g]];
    if (in.shape == ShapeType::kDeformable) {
      const MeshView& mesh = scene.meshes()[in.mesh];
      const bool blurred = !mesh.positions_close.empty();
      rtcSetGeometryTimeStepCount(geometry, blurred ? 2 : 1);
      set_vertices(geometry, 0, mesh.positions.data, mesh.positions.size);
      if (blurred) set_vertices(geometry, 1, mesh.positions_close.data, mesh.positions_close.size);
    } else {
      rtcSetGeometryTimeStepCount(geometry, in.moving ? 2 : 1);
      set_transform(geometry, 0, in.X_WG);
      if (in.moving) set_transform(geometry, 1, in.X_WG_close);
    }
    rtcCommitGeometry(geometry);
  }
  if (!root_rows_.empty()) rtcCommitScene(root_.get());
  if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE) {
    return Error{ErrorKind::kUnsupported,
                 error == RTC_ERROR_OUT_OF_MEMORY
                     ? "not enough memory for the scene's BVH"
                     : fmt::format("Embree reports error {}", static_cast<int>(error))};
  }
  return {};
}

EmbreeTracer EmbreeScene::tracer(const RenderScene& scene) const {
  const auto span = [](const auto& v) {
    return DeviceSpan<const std::decay_t<decltype(v[0])>>{v.data(),
                                                          static_cast<uint32_t>(v.size())};
  };
  EmbreeTracer tracer;
  const bool has_root = !root_rows_.empty();
  tracer.root = has_root ? root_.get() : static_.get();
  tracer.static_id = static_id_;
  tracer.root_rows = has_root ? span(root_rows_) : span(static_rows_);
  tracer.static_rows = span(static_rows_);
  tracer.planes = span(planes_);
  tracer.instances = span(scene.instances());
  return tracer;
}

}  // namespace gloam
