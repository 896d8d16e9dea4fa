#include "render/cpu/tracer/embree_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/log.h"
#include "base/parallel.h"
#include "render/renderer.h"
#include "render/scene/pose.h"

namespace gloam {
namespace {

/// Number of solids that stand still and are scanned, at most: 40 take half the time that they take
/// in a BVH, and the time grows with their number.
constexpr size_t kMaxScanned = 64;

/// Copies of one mesh that stand still are triangles of the world, which rays pass fastest, until
/// all but the first have so many: then they are instances, and memory holds the mesh once.
constexpr uint64_t kMaxCopied = 1 << 18;

void commit(const std::vector<RTCScene>& shapes) {
  parallel_for("shape BVHs", static_cast<int64_t>(shapes.size()),
               [&](int64_t i) { rtcCommitScene(shapes[static_cast<size_t>(i)]); });
}

/// Bounds over the whole time of the shutter.
Bounds bounds_of(RTCScene scene) {
  RTCLinearBounds b;
  rtcGetSceneLinearBounds(scene, &b);
  const RTCBounds &open = b.bounds0, &close = b.bounds1;
  return wider({{min(open.lower_x, close.lower_x), min(open.lower_y, close.lower_y),
                 min(open.lower_z, close.lower_z)},
                {max(open.upper_x, close.upper_x), max(open.upper_y, close.upper_y),
                 max(open.upper_z, close.upper_z)}});
}

void bound_shape(const RTCBoundsFunctionArguments* args) {
  const ShapeGeometry& g = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
  const Bounds b = wider(shape_bounds(g.shape, g.size, g.X_SG));
  *args->bounds_o = {b.low.x, b.low.y, b.low.z, 0, b.high.x, b.high.y, b.high.z, 0};
}

float hit_distance(const ShapeGeometry& g, RTCRayN* rays, unsigned n, unsigned i) {
  const Vec3f o =
      Vec3f{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)} -
      g.X_SG.p;
  const Vec3f d{RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
  return intersect_shape(g.shape, g.size, to_frame(g.X_SG, o), to_frame(g.X_SG, d),
                         RTCRayN_tnear(rays, n, i), RTCRayN_tfar(rays, n, i));
}

void shape_intersect(const RTCIntersectFunctionNArguments* args) {
  const ShapeGeometry& g = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const float t = hit_distance(g, rays, args->N, i);
    if (!(t > 0)) continue;
    RTCRayN_tfar(rays, args->N, i) = t;
    RTCHitN_geomID(hits, args->N, i) = args->geomID;
    RTCHitN_primID(hits, args->N, i) = 0;
    RTCHitN_instID(hits, args->N, i, 0) = args->context->instID[0];
  }
}

void shape_occluded(const RTCOccludedFunctionNArguments* args) {
  const ShapeGeometry& g = *static_cast<const ShapeGeometry*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    if (hit_distance(g, args->ray, args->N, i) > 0) {
      RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
    }
  }
}

void set_transform(RTCGeometry geometry, unsigned key, const Affine3f& X) {
  const float columns[12] = {X.x.x, X.x.y, X.x.z, X.y.x, X.y.y, X.y.z,
                             X.z.x, X.z.y, X.z.z, X.p.x, X.p.y, X.p.z};
  rtcSetGeometryTransform(geometry, key, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
}

// Embree may read 16 bytes at the last vertex of a shared buffer: buffers it
// owns are padded.
void set_vertices(RTCGeometry geometry, unsigned key, const Vec3f* vertices, size_t count) {
  void* out = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key, RTC_FORMAT_FLOAT3,
                                      sizeof(Vec3f), count);
  if (out != nullptr) std::memcpy(out, vertices, count * sizeof(Vec3f));
}

/// Whether Embree has these vertices at a key.
bool has_vertices(RTCGeometry geometry, unsigned key, const Vec3f* vertices, size_t count) {
  const void* const known = rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, key);
  return known != nullptr && std::memcmp(known, vertices, count * sizeof(Vec3f)) == 0;
}

/// Gives a deformable its vertices. False if it has them already.
bool deform(const MeshView& mesh, MovingGeometry* moving) {
  const RTCGeometry geometry = moving->geometry.get();
  const size_t n = mesh.positions.size;
  const unsigned count = std::max(mesh.key_count, 1u);
  const auto vertices_at = [&](unsigned k) {
    return k == 0 ? mesh.positions.data : mesh.position_keys.data + k * n;
  };
  bool is_known = count == moving->key_count;
  for (unsigned k = 0; k < count && is_known; ++k)
    is_known = has_vertices(geometry, k, vertices_at(k), n);
  if (is_known) return false;
  moving->key_count = count;
  rtcSetGeometryTimeStepCount(geometry, count);
  for (unsigned k = 0; k < count; ++k) set_vertices(geometry, k, vertices_at(k), n);
  return true;
}

/// Gives an instance its poses. False if it has them already.
bool move(const InstanceView& in, MovingGeometry* moving) {
  std::vector<Affine3f>& poses = moving->poses;
  const unsigned count = std::max(in.keys.size, 1u);
  const auto pose_at = [&](unsigned k) { return k == 0 ? in.X_WG : in.keys[k]; };
  bool is_known = poses.size() == count;
  for (unsigned k = 0; k < count && is_known; ++k) is_known = is_same(poses[k], pose_at(k));
  if (is_known) return false;
  poses.resize(count);
  rtcSetGeometryTimeStepCount(moving->geometry.get(), count);
  for (unsigned k = 0; k < count; ++k) {
    poses[k] = pose_at(k);
    set_transform(moving->geometry.get(), k, poses[k]);
  }
  return true;
}

void set_indices(RTCGeometry geometry, const uint32_t* indices, size_t triangles) {
  void* out = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                      3 * sizeof(uint32_t), triangles);
  if (out != nullptr) std::memcpy(out, indices, triangles * 3 * sizeof(uint32_t));
}

}  // namespace

Result<std::unique_ptr<EmbreeScene>> EmbreeScene::make() {
  RtcOwner<RTCDevice> device(rtcNewDevice(nullptr));
  if (device == nullptr) {
    const RTCError error = rtcGetDeviceError(nullptr);
    return Error{ErrorKind::kUnsupported,
                 error == RTC_ERROR_OUT_OF_MEMORY
                     ? "out of memory: cannot initialize Embree"
                     : fmt::format("cannot initialize Embree (error {})", static_cast<int>(error))};
  }
  if (!is_embree_of_headers(device.get()))
    return Error{ErrorKind::kUnsupported,
                 fmt::format("built with the headers of Embree {}, but the loaded library has a "
                             "different major version",
                             RTC_VERSION_MAJOR),
                 {},
                 "run ./gloam setup to build for the Embree version on this machine"};
  return std::unique_ptr<EmbreeScene>(new EmbreeBuild(std::move(device)));
}

std::string ray_tracer_version() {
  return fmt::format("Embree {}.{}.{}", RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH);
}

RtcOwner<RTCScene> EmbreeBuild::new_scene() {
  RtcOwner<RTCScene> scene(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

RtcOwner<RTCGeometry> EmbreeBuild::mesh_geometry(const MeshView& mesh) {
  RtcOwner<RTCGeometry> geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  set_vertices(geometry.get(), 0, mesh.positions.data, mesh.positions.size);
  set_indices(geometry.get(), mesh.indices.data, mesh.indices.size / 3);
  return geometry;
}

// Boxes are triangles to Embree: its leaves test four of them faster than one
// callback.
RtcOwner<RTCGeometry> EmbreeBuild::box_geometry(Vec3f size, const Affine3f& X_SG) {
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

RtcOwner<RTCGeometry> EmbreeBuild::shape_geometry(ShapeType shape, Vec3f size,
                                                  const Affine3f& X_SG) {
  if (shape == ShapeType::kBox) return box_geometry(size, X_SG);
  RtcOwner<RTCGeometry> geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
  shape_data_.push_back(std::make_unique<ShapeGeometry>(ShapeGeometry{shape, size, X_SG}));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), 1);
  rtcSetGeometryUserData(geometry.get(), shape_data_.back().get());
  rtcSetGeometryBoundsFunction(geometry.get(), bound_shape, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), shape_intersect);
  rtcSetGeometryOccludedFunction(geometry.get(), shape_occluded);
  return geometry;
}

RTCScene EmbreeBuild::shape_of(const RenderScene& scene, const InstanceView& in,
                               std::vector<RTCScene>* to_commit) {
  const ShapeKey key = is_mesh(in.shape) ? ShapeKey{in.shape, in.mesh, 0, 0, 0}
                                         : ShapeKey{in.shape, 0, in.size.x, in.size.y, in.size.z};
  RtcOwner<RTCScene>& shape = shapes_[key];
  if (shape == nullptr) {
    shape = new_scene();
    const RtcOwner<RTCGeometry> geometry = is_mesh(in.shape)
                                               ? mesh_geometry(scene.meshes()[in.mesh])
                                               : shape_geometry(in.shape, in.size, {});
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(shape.get(), geometry.get(), 0);
    to_commit->push_back(shape.get());
  }
  return shape.get();
}

RtcOwner<RTCGeometry> EmbreeBuild::instance_of(RTCScene shape) {
  RtcOwner<RTCGeometry> instance(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(instance.get(), shape);
  return instance;
}

void EmbreeBuild::build_fixed(const RenderScene& scene) {
  fixed_ = new_scene();
  bool empty = true;
  const std::vector<InstanceView>& instances = scene.instances();
  std::vector<uint64_t> copies(scene.meshes().size());
  for (size_t i = 0; i < instances.size(); ++i)
    if (is_mesh(instances[i].shape) && stands_still(scene, i)) ++copies[instances[i].mesh];
  std::vector<RTCScene> to_commit;
  for (size_t i = 0; i < instances.size(); ++i) {
    const InstanceView& in = instances[i];
    if (!stands_still(scene, i) || scanned_.holds(i)) continue;
    RtcOwner<RTCGeometry> geometry;
    if (is_mesh(in.shape) &&
        (copies[in.mesh] - 1) * (scene.meshes()[in.mesh].indices.size / 3) > kMaxCopied) {
      geometry = instance_of(shape_of(scene, in, &to_commit));
      set_transform(geometry.get(), 0, in.X_WG);
    } else if (is_mesh(in.shape)) {
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
    rtcAttachGeometryByID(fixed_.get(), geometry.get(), static_cast<unsigned>(rows_.size()));
    rows_.push_back(static_cast<uint32_t>(i));
    empty = false;
  }
  commit(to_commit);
  if (empty) {
    fixed_.reset();
  } else {
    rtcCommitScene(fixed_.get());
  }
}

void EmbreeBuild::build_shapes(const RenderScene& scene) {
  std::vector<RTCScene> to_commit;
  const std::vector<InstanceView>& instances = scene.instances();
  for (size_t i = 0; i < instances.size(); ++i) {
    const InstanceView& in = instances[i];
    if (scene.is_fixed(i) || in.shape == ShapeType::kDeformable || is_infinite_plane(in) ||
        !scene.is_drawn(i)) {
      continue;
    }
    RtcOwner<RTCGeometry> instance = instance_of(shape_of(scene, in, &to_commit));
    rtcAttachGeometryByID(moving_.get(), instance.get(), static_cast<unsigned>(rows_.size()));
    rows_.push_back(static_cast<uint32_t>(i));
    moving_geometries_.push_back({std::move(instance)});
  }
  commit(to_commit);
}

void EmbreeBuild::rebuild_mesh(const RenderScene& scene, uint32_t mesh) {
  const auto shape = shapes_.find({ShapeType::kMesh, mesh, 0, 0, 0});
  if (shape == shapes_.end()) return;  // it is not drawn
  const RtcOwner<RTCGeometry> geometry = mesh_geometry(scene.meshes()[mesh]);
  rtcCommitGeometry(geometry.get());
  rtcDetachGeometry(shape->second.get(), 0);
  rtcAttachGeometryByID(shape->second.get(), geometry.get(), 0);
  rtcCommitScene(shape->second.get());
}

void EmbreeBuild::build(const RenderScene& scene) {
  drawn_version_ = scene.drawn_version();
  moving_geometries_.clear();
  moving_.reset();
  fixed_.reset();
  shapes_.clear();
  shape_data_.clear();
  rows_.clear();
  build_moving(scene);
  scanned_ = ScanTable::choose(scene, kMaxScanned, 0);
  for (const ScannedSolid& solid : scanned_.solids) rows_.push_back(solid.row);
  build_fixed(scene);
}

void EmbreeBuild::build_moving(const RenderScene& scene) {
  moving_ = new_scene();
  rtcSetSceneFlags(moving_.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
  build_shapes(scene);
  const std::vector<InstanceView>& instances = scene.instances();
  for (size_t i = 0; i < instances.size(); ++i) {
    if (instances[i].shape != ShapeType::kDeformable || !scene.is_drawn(i)) continue;
    RtcOwner<RTCGeometry> geometry = mesh_geometry(scene.meshes()[instances[i].mesh]);
    // Embree refits in scenes of low quality only, in a twentieth of the time of a build.
    rtcSetSceneBuildQuality(moving_.get(), RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_REFIT);
    rtcAttachGeometryByID(moving_.get(), geometry.get(), static_cast<unsigned>(rows_.size()));
    rows_.push_back(static_cast<uint32_t>(i));
    moving_geometries_.push_back({std::move(geometry)});
  }
  if (rows_.empty()) moving_.reset();
}

Status EmbreeBuild::update(const RenderScene& scene) {
  if (drawn_version_ != scene.drawn_version()) build(scene);
  for (const uint32_t mesh : scene.rebuilt_meshes()) rebuild_mesh(scene, mesh);
  // Sensors that share an instant update the scene to it one after the other.
  const bool has_new_shapes = !scene.rebuilt_meshes().empty();
  bool has_changed = has_new_shapes;
  for (size_t g = 0; g < moving_geometries_.size(); ++g) {
    MovingGeometry& moving = moving_geometries_[g];
    const InstanceView& in = scene.instances()[rows_[g]];
    const bool moves = in.shape == ShapeType::kDeformable ? deform(scene.meshes()[in.mesh], &moving)
                                                          : move(in, &moving);
    // An instance takes the bounds of a rebuilt mesh when it is committed.
    if (moves || has_new_shapes) rtcCommitGeometry(moving.geometry.get());
    has_changed |= moves;
  }
  if (moving_ != nullptr && has_changed) rtcCommitScene(moving_.get());
  if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE) {
    return Error{ErrorKind::kUnsupported,
                 error == RTC_ERROR_OUT_OF_MEMORY
                     ? "not enough memory for the scene's BVH"
                     : fmt::format("Embree reports error {}", static_cast<int>(error))};
  }
  return {};
}

CpuTracer EmbreeBuild::static_tracer(const RenderScene& scene) const {
  CpuTracer tracer = this->tracer(scene);
  tracer.moving = {};
  tracer.scanned.planes = {};
  return tracer;
}

CpuTracer EmbreeBuild::tracer(const RenderScene& scene) const {
  const auto span = [](const auto& v) {
    return DeviceSpan<const std::decay_t<decltype(v[0])>>{v.data(),
                                                          static_cast<uint32_t>(v.size())};
  };
  CpuTracer tracer;
  if (fixed_ != nullptr) tracer.fixed = {fixed_.get(), bounds_of(fixed_.get())};
  if (moving_ != nullptr) tracer.moving = {moving_.get(), bounds_of(moving_.get())};
  tracer.rows = span(rows_);
  tracer.first_still = static_cast<uint32_t>(moving_geometries_.size());
  tracer.scanned = scanned_.list(scene);
  return tracer;
}

}  // namespace gloam
