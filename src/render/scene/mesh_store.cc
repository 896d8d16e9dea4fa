#include "render/scene/mesh_store.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"
#include "render/scene/span_of.h"
#include "world/shapes/visual_mesh.h"

namespace gloam {
namespace {

bool is_finite_point(Vec3f v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check_mesh(const TriangleMesh& mesh, const std::string& name) {
  const auto bad = [&](const char* what) {
    return Error{ErrorKind::kInput, fmt::format("{} {}", name, what)};
  };
  const size_t n = mesh.positions.size();
  if (mesh.indices.size() % 3 != 0) return bad("has an incomplete triangle");
  if (!mesh.normals.empty() && mesh.normals.size() != n) return bad("has too few or many normals");
  if (!mesh.uvs.empty() && mesh.uvs.size() != n) return bad("has too few or many uvs");
  if (std::any_of(mesh.indices.begin(), mesh.indices.end(), [n](uint32_t i) { return i >= n; })) {
    return bad("has a triangle with a vertex that does not exist");
  }
  if (!std::all_of(mesh.uvs.begin(), mesh.uvs.end(),
                   [](Vec2f uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); })) {
    return bad("has a texture coordinate that is not a finite number");
  }
  if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite_point)) {
    return bad("has a vertex that is not a finite number");
  }
  return {};
}

float triangle_area(const std::vector<Vec3f>& positions, const uint32_t* index) {
  const Vec3f a = positions[index[0]];
  return 0.5f * length(cross(positions[index[1]] - a, positions[index[2]] - a));
}

void fill_static_data(const TriangleMesh& mesh, MeshBuffers* out) {
  const size_t count = mesh.triangle_count();
  if (!mesh.normals.empty()) {
    out->corner_normals.resize(mesh.indices.size());
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
      out->corner_normals[i] = mesh.normals[mesh.indices[i]];
    }
  }
  if (!mesh.uvs.empty()) {
    out->uvs.resize(count);
    for (size_t t = 0; t < count; ++t) {
      TriangleUv& uv = out->uvs[t];
      for (int k = 0; k < 3; ++k) uv.corner[k] = mesh.uvs[mesh.indices[3 * t + k]];
      const Vec2f a = uv.corner[1] - uv.corner[0], b = uv.corner[2] - uv.corner[0];
      const float uv_area = 0.5f * std::fabs(a.x * b.y - a.y * b.x);
      uv.density =
          std::sqrt(uv_area / max(triangle_area(mesh.positions, &mesh.indices[3 * t]), 1e-12f));
    }
  }
  Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  for (const Vec3f& p : mesh.positions) {
    low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
    high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
  }
  if (!mesh.positions.empty()) out->half_extents = (high - low) * 0.5f;
}

/// Smooth normals of moved vertices, weighted by triangle area.
void recompute_normals(const TriangleMesh& mesh, MeshBuffers* buffers) {
  std::vector<Vec3f> sum(buffers->open.size());
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t* i = &mesh.indices[3 * t];
    const Vec3f a = buffers->open[i[0]];
    const Vec3f n = cross(buffers->open[i[1]] - a, buffers->open[i[2]] - a);
    for (int k = 0; k < 3; ++k) sum[i[k]] += n;
  }
  buffers->corner_normals.resize(mesh.indices.size());
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    const Vec3f n = sum[mesh.indices[i]];
    const float l = length(n);
    buffers->corner_normals[i] = l > 0 ? n / l : Vec3f{0, 0, 1};
  }
}

}  // namespace

Result<MeshStore> MeshStore::make(const RenderDescription& description) {
  MeshStore store;
  const size_t rigid = description.meshes.size();
  const size_t count = rigid + description.deformables.size();
  const auto mesh_of = [&](size_t i) -> const TriangleMesh& {
    return i < rigid ? description.meshes[i] : description.deformables[i - rigid].rest;
  };
  for (size_t i = 0; i < count; ++i) {
    GLOAM_TRY_STATUS(check_mesh(mesh_of(i), i < rigid ? fmt::format("mesh {}", i)
                                                      : fmt::format("deformable {}", i - rigid)));
  }
  store.meshes_.resize(count);
  parallel_for("mesh shading data", static_cast<int64_t>(count),
               [&](int64_t i) { fill_static_data(mesh_of(i), &store.meshes_[i]); });
  return store;
}

void MeshStore::update(const RenderDescription& description, std::span<const PoseFrame* const> keys,
                       const PoseFrame& previous) {
  const size_t rigid = description.meshes.size();
  const auto count = static_cast<int64_t>(description.deformables.size());
  parallel_for("deformables", count, [&](int64_t row) {
    const auto d = static_cast<size_t>(row);
    const DeformableDescription& deformable = description.deformables[d];
    MeshBuffers& buffers = meshes_[rigid + d];
    const size_t n = deformable.rest.positions.size();
    const auto take = [&](const PoseFrame& frame, std::vector<Vec3f>* out) {
      GLOAM_CHECK(frame.vertices.size() >= 3 * (deformable.first_vertex + n),
                  "the pose frame lacks vertices of a deformable");
      const float* v = frame.vertices.data() + 3 * deformable.first_vertex;
      for (size_t i = 0; i < n; ++i) out->push_back({v[3 * i], v[3 * i + 1], v[3 * i + 2]});
    };
    buffers.open.clear();
    buffers.previous.clear();
    buffers.keys.clear();
    take(*keys.front(), &buffers.open);
    take(previous, &buffers.previous);
    if (keys.size() > 1) {
      for (const PoseFrame* key : keys) take(*key, &buffers.keys);
    }
    bool moving = false;
    for (size_t k = 1; k < keys.size() && !moving; ++k)
      moving = !std::equal(buffers.open.begin(), buffers.open.end(), buffers.keys.begin() + k * n);
    buffers.key_count = moving ? static_cast<uint32_t>(keys.size()) : 0;
    recompute_normals(deformable.rest, &buffers);
    if (!buffers.area_cdf.empty()) make_samplable(description, static_cast<uint32_t>(rigid + d));
  });
}

const TriangleMesh& MeshStore::mesh_at(const RenderDescription& description, size_t row) const {
  if (meshes_[row].rebuilt) return *meshes_[row].rebuilt;
  const size_t rigid = description.meshes.size();
  return row < rigid ? description.meshes[row] : description.deformables[row - rigid].rest;
}

bool MeshStore::rebuild(const RenderDescription& description, const HeightFieldDescription& field,
                        const PoseFrame& frame) {
  const auto row = static_cast<size_t>(field.mesh);
  std::optional<TriangleMesh> mesh;
  if (!frame.height_field.empty()) {
    const size_t first = static_cast<size_t>(field.first_data);
    const size_t count = static_cast<size_t>(field.rows) * static_cast<size_t>(field.columns);
    GLOAM_CHECK(frame.height_field.size() >= first + count,
                "the pose frame lacks data of a height field");
    mesh = height_field_mesh(field, std::span(frame.height_field).subspan(first, count));
  }
  const TriangleMesh& now = mesh ? *mesh : description.meshes[row];
  if (now.positions == mesh_at(description, row).positions) return false;
  const bool samplable = !meshes_[row].area_cdf.empty();
  meshes_[row] = {};
  fill_static_data(now, &meshes_[row]);
  meshes_[row].rebuilt = std::move(mesh);
  if (samplable) make_samplable(description, static_cast<uint32_t>(row));
  return true;
}

void MeshStore::make_samplable(const RenderDescription& description, uint32_t row) {
  const TriangleMesh& mesh = mesh_at(description, row);
  MeshBuffers& buffers = meshes_[row];
  const std::vector<Vec3f>& positions = buffers.open.empty() ? mesh.positions : buffers.open;
  buffers.area_cdf.assign(1, 0.0f);
  double sum = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    sum += triangle_area(positions, &mesh.indices[3 * t]);
    buffers.area_cdf.push_back(static_cast<float>(sum));
  }
  buffers.area = static_cast<float>(sum);
  for (float& value : buffers.area_cdf) value /= max(buffers.area, 1e-30f);
}

std::vector<MeshView> MeshStore::views(const RenderDescription& description) const {
  std::vector<MeshView> views(meshes_.size());
  for (size_t i = 0; i < meshes_.size(); ++i) {
    const MeshBuffers& buffers = meshes_[i];
    const TriangleMesh& mesh = mesh_at(description, i);
    MeshView& view = views[i];
    view.positions = span_of(buffers.open.empty() ? mesh.positions : buffers.open);
    if (buffers.key_count > 0) view.position_keys = span_of(buffers.keys);
    view.key_count = buffers.key_count;
    view.positions_previous = span_of(buffers.previous);
    view.indices = span_of(mesh.indices);
    view.corner_normals = span_of(buffers.corner_normals);
    view.uvs = span_of(buffers.uvs);
    view.area_cdf = span_of(buffers.area_cdf);
    view.area = buffers.area;
  }
  return views;
}

}  // namespace gloam
