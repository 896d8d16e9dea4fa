#include "world/shapes/geom_importer.h"

#include <fmt/format.h>

#include <cstddef>
#include <span>

#include "base/parallel.h"
#include "world/model_names.h"
#include "world/shapes/visual_mesh.h"
#include "world/shapes/visual_pose.h"

namespace gloam {
namespace {

/// Vec3f and Vec2f are packed floats: MuJoCo's arrays are read in place.
std::span<const Vec3f> vec3_span(const float* data, int first, int count) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  return {reinterpret_cast<const Vec3f*>(data) + first, static_cast<size_t>(count)};
}
std::span<const Vec2f> vec2_span(const float* data, int first, int count) {
  static_assert(sizeof(Vec2f) == 2 * sizeof(float));
  return {reinterpret_cast<const Vec2f*>(data) + first, static_cast<size_t>(count)};
}

TriangleMesh convert_mesh(const mjModel& m, int i) {
  const auto faces = [&](const int* data) {
    return std::span<const int>(data + 3 * m.mesh_faceadr[i],
                                3 * static_cast<size_t>(m.mesh_facenum[i]));
  };
  IndexedCorners corners;
  corners.positions = vec3_span(m.mesh_vert, m.mesh_vertadr[i], m.mesh_vertnum[i]);
  corners.normals = vec3_span(m.mesh_normal, m.mesh_normaladr[i], m.mesh_normalnum[i]);
  corners.face = faces(m.mesh_face);
  corners.face_normal = faces(m.mesh_facenormal);
  if (m.mesh_texcoordadr[i] >= 0 && m.mesh_texcoordnum[i] > 0) {
    corners.uvs = vec2_span(m.mesh_texcoord, m.mesh_texcoordadr[i], m.mesh_texcoordnum[i]);
    corners.face_uv = faces(m.mesh_facetexcoord);
  }
  return split_corners(corners);
}

}  // namespace

int GeomImporter::mesh_row(int asset, bool is_height_field) {
  const auto [entry, added] =
      mesh_rows_.try_emplace({asset, is_height_field}, static_cast<int>(out_->meshes.size()));
  if (!added) return entry->second;
  out_->meshes.emplace_back();
  PendingMesh pending{asset, entry->second, -1};
  if (is_height_field) {
    const mjtNum* size = model_.hfield_size + 4 * asset;
    HeightFieldDescription field;
    field.mesh = entry->second;
    field.first_data = model_.hfield_adr[asset];
    field.rows = model_.hfield_nrow[asset];
    field.columns = model_.hfield_ncol[asset];
    field.size = {static_cast<float>(size[0]), static_cast<float>(size[1]),
                  static_cast<float>(size[2])};
    field.base = static_cast<float>(size[3]);
    pending.height_field = static_cast<int>(out_->height_fields.size());
    out_->height_fields.push_back(field);
  }
  pending_.push_back(pending);
  return entry->second;
}

std::optional<InstanceDescription> GeomImporter::instance(int g) {
  const mjModel& m = model_;
  const float* rgba = m.geom_rgba + 4 * g;
  // A Command may make fully transparent geoms visible, but only in the simulated model.
  if (!live_ && drawn_rgba(m, m.geom_matid[g], rgba)[3] == 0) return std::nullopt;
  InstanceDescription instance;
  const mjtNum* size = m.geom_size + 3 * g;
  instance.size = {static_cast<float>(size[0]), static_cast<float>(size[1]),
                   static_cast<float>(size[2])};
  const int asset = m.geom_dataid[g];
  switch (m.geom_type[g]) {
    case mjGEOM_PLANE:
      instance.shape = ShapeType::kPlane;
      instance.size.z = 0;
      break;
    case mjGEOM_SPHERE:
      instance.shape = ShapeType::kSphere;
      break;
    case mjGEOM_CAPSULE:
      instance.shape = ShapeType::kCapsule;
      break;
    case mjGEOM_ELLIPSOID:
      instance.shape = ShapeType::kEllipsoid;
      break;
    case mjGEOM_CYLINDER:
      instance.shape = ShapeType::kCylinder;
      break;
    case mjGEOM_BOX:
      instance.shape = ShapeType::kBox;
      break;
    case mjGEOM_HFIELD:
      instance.shape = ShapeType::kMesh;
      instance.mesh = mesh_row(asset, true);
      instance.size = {static_cast<float>(m.hfield_size[4 * asset]),
                       static_cast<float>(m.hfield_size[4 * asset + 1]),
                       static_cast<float>(m.hfield_size[4 * asset + 2])};
      break;
    case mjGEOM_MESH:
    case mjGEOM_SDF:
      if (asset >= 0) {
        instance.shape = ShapeType::kMesh;
        instance.mesh = mesh_row(asset, false);
        break;
      }
      [[fallthrough]];
    default:
      out_->unsupported.push_back(
          {ErrorKind::kUnsupported,
           fmt::format("geom '{}' has a shape that is not drawn", name_of(m, mjOBJ_GEOM, g))});
      return std::nullopt;
  }
  instance.material = materials_.row(m.geom_matid[g], rgba, instance.shape);
  instance.group = m.geom_group[g];
  instance.geom = live_ ? g : -1;
  instance.casts_shadow = m.geom_castshadow[g] != 0;
  instance.X_BG = rigid_pose(m.geom_pos + 3 * g, m.geom_quat + 4 * g);
  return instance;
}

void GeomImporter::convert_meshes() {
  parallel_for("world.meshes", static_cast<int64_t>(pending_.size()), [&](int64_t i) {
    const PendingMesh& pending = pending_[static_cast<size_t>(i)];
    TriangleMesh& mesh = out_->meshes[static_cast<size_t>(pending.row)];
    if (pending.height_field < 0) {
      mesh = convert_mesh(model_, pending.asset);
      return;
    }
    const auto& field = out_->height_fields[static_cast<size_t>(pending.height_field)];
    mesh = height_field_mesh(field, {model_.hfield_data + field.first_data,
                                     static_cast<size_t>(field.rows) * field.columns});
  });
}

}  // namespace gloam
