#include "render/cuda/device_scene.h"

namespace gloam::cuda {
const void* DeviceScene::keep(const void* data, size_t bytes) {
  if (bytes == 0 || data == nullptr) return nullptr;
  Kept& kept = kept_[data];
  if (kept.bytes != bytes) {
    kept.bytes = bytes;
    check(cudaMemcpy(kept.buffer.reserve(bytes), data, bytes, cudaMemcpyHostToDevice),
          "cannot copy the scene to the GPU");
  }
  return kept.buffer.data();
}
template <class T>
DeviceSpan<const T> DeviceScene::keep(DeviceSpan<const T> span) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {static_cast<const T*>(keep(span.data, span.size * sizeof(T))), span.size};
}

MeshView DeviceScene::keep_mesh(const MeshView& mesh, bool deforms, Parcel* parcel) {
  MeshView out = mesh;
  out.indices = keep(mesh.indices);
  out.uvs = keep(mesh.uvs);
  out.area_cdf = deforms ? parcel->put(mesh.area_cdf) : keep(mesh.area_cdf);
  out.positions = deforms ? parcel->put(mesh.positions) : keep(mesh.positions);
  out.position_keys = parcel->put(mesh.position_keys);
  out.positions_previous = parcel->put(mesh.positions_previous);
  out.corner_normals = deforms ? parcel->put(mesh.corner_normals) : keep(mesh.corner_normals);
  return out;
}

void DeviceScene::fill(const CudaJob& job, Parcel* parcel, DevicePicture* picture) {
  const SceneView& scene = job.view;
  const BvhScene& bvh = job.bvh;
  SceneView& out = picture->scene;
  out = scene;
  picture->camera = job.camera;
  picture->camera.pose.keys = parcel->put(job.camera.pose.keys);
  picture->clip = job.clip;
  picture->clip.hidden = parcel->put(job.clip.hidden);
  std::vector<bool> deforms(scene.meshes.size);
  std::vector<InstanceView> instances(scene.instances.data,
                                      scene.instances.data + scene.instances.size);
  for (InstanceView& instance : instances) {
    if (instance.shape == ShapeType::kDeformable) deforms[instance.mesh] = true;
    if (instance.moving) instance.keys = parcel->put(instance.keys);
  }
  std::vector<MeshView> meshes;
  for (uint32_t i = 0; i < scene.meshes.size; ++i) {
    meshes.push_back(keep_mesh(scene.meshes[i], deforms[i], parcel));
  }
  std::vector<VolumeView> volumes;
  for (uint32_t i = 0; i < scene.media.volumes.size; ++i) {
    VolumeView volume = scene.media.volumes[i];
    const auto bring = [&](auto span) { return volume.changes ? parcel->put(span) : keep(span); };
    volume.density = bring(volume.density);
    volume.temperature = bring(volume.temperature);
    volume.cells = bring(volume.cells);
    volumes.push_back(volume);
  }
  out.instances = parcel->put(instances);
  out.meshes = parcel->put(meshes);
  out.materials = parcel->put(scene.materials);
  out.layers = parcel->put(scene.layers);
  out.lights = parcel->put(scene.lights);
  out.light_keys = parcel->put(scene.light_keys);
  out.light_levels = parcel->put(scene.light_levels);
  out.light_tree.nodes = parcel->put(scene.light_tree.nodes);
  out.light_tree.leaf_of = parcel->put(scene.light_tree.leaf_of);
  out.media.volumes = parcel->put(volumes);
  out.media.black_body.luminance = keep(scene.media.black_body.luminance);
  out.textures = keep(scene.textures);
  out.texture_levels = keep(scene.texture_levels);
  out.texels = keep(scene.texels);
  out.profiles = keep(scene.profiles);
  out.profile_values = keep(scene.profile_values);
  out.procedurals = {};
  out.baked.patterns = keep(scene.baked.patterns);
  out.baked.slots = keep(scene.baked.slots);
  out.baked.texels = keep(scene.baked.texels);
  out.albedo = static_cast<const AlbedoTable*>(keep(scene.albedo, sizeof(AlbedoTable)));
  if (scene.glass != nullptr) {
    out.glass = static_cast<const GlassTable*>(keep(scene.glass, sizeof(GlassTable)));
  }
  out.fallen.shelter.height = keep(scene.fallen.shelter.height);
  out.guide.surface_row = keep(scene.guide.surface_row);
  out.guide.gain = keep(scene.guide.gain);
  out.guide.sky_visible = keep(scene.guide.sky_visible);
  out.guide.arriving = keep(scene.guide.arriving);
  const auto bring = [&](auto span) {
    return scene.environment.changes ? parcel->put(span) : keep(span);
  };
  out.environment.texels = bring(scene.environment.texels);
  out.environment.levels = bring(scene.environment.levels);
  out.environment.row_cdf = bring(scene.environment.row_cdf);
  out.environment.column_cdf = bring(scene.environment.column_cdf);

  const BvhTracer tracer = bvh.tracer(job.scene);
  BvhTracer& device = picture->tracer;
  device.bvh.instances = parcel->put(bvh.instances()).data;
  device.bvh.motion = parcel->put(bvh.motion()).data;
  device.bvh.key_count = tracer.bvh.key_count;
  device.bvh.root = tracer.bvh.root;
  device.scanned.planes = parcel->put(tracer.scanned.planes);
  device.scanned.solids = parcel->put(tracer.scanned.solids);
  device.scanned.instances = out.instances;
}

template <class T>
void DeviceScene::upload_tree(const std::vector<T>& from, size_t fresh, Parcel* parcel,
                              DeviceBuffer* to) {
  parts_.push_back({parcel->put(from.data(), fresh * sizeof(T)), to, fresh * sizeof(T)});
}

void DeviceScene::fill_all(const CudaJob& job, Parcel* parcel, DevicePicture* picture) {
  fill(job, parcel, picture);
  parts_.clear();
  upload_tree(job.bvh.nodes(), job.bvh.fresh_nodes(), parcel, &nodes_);
  upload_tree(job.bvh.triangles(), job.bvh.fresh_triangles(), parcel, &triangles_);
}

void DeviceScene::upload(const CudaJob& job, Stream stream, PinnedBuffer* staging,
                         DevicePicture* picture) {
  const auto copy = [stream](void* to, const void* from, size_t bytes, cudaMemcpyKind kind) {
    if (bytes == 0) return;
    check(cudaMemcpyAsync(to, from, bytes, kind, stream), "cannot copy the scene to the GPU");
  };
  place_.send([&](Parcel* parcel) { fill_all(job, parcel, picture); }, staging, stream);
  const BvhScene& bvh = job.bvh;
  const auto all = [&](const auto& from, DeviceBuffer* to) {
    const size_t bytes = from.size() * sizeof(from[0]);
    copy(to->reserve(bytes), from.data(), bytes, cudaMemcpyHostToDevice);
  };
  if (bvh_version_ != bvh.version()) {
    bvh_version_ = bvh.version();
    all(bvh.nodes(), &nodes_);
    all(bvh.triangles(), &triangles_);
  }
  for (const TreePart& part : parts_)
    copy(part.to->data(), part.from, part.bytes, cudaMemcpyDeviceToDevice);
  picture->tracer.bvh.nodes = static_cast<const BvhNode*>(nodes_.data());
  picture->tracer.bvh.triangles = static_cast<const BvhTriangle*>(triangles_.data());
}

}  // namespace gloam::cuda
