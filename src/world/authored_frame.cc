#include "world/authored_frame.h"

#include <algorithm>
#include <map>

#include "world/shapes/visual_pose.h"

namespace gloam {
namespace {

bool wants_own_frame(const MaterialDescription& material) {
  const std::array<int, 12> textures = material.textures.all();
  return (material.pattern >= 0 || material.wear >= 0) &&
         std::all_of(textures.begin(), textures.end(), [](int t) { return t < 0; });
}

}  // namespace

void restore_authored_frames(const mjModel& m, RenderDescription* out) {
  // Maps by row of the mesh: the row with the mesh in its authored frame; whether other instances
  // need the row as it is.
  std::map<int, int> restored;
  std::map<int, bool> shared;
  const auto is_ours = [&](const InstanceDescription& in) {
    return in.shape == ShapeType::kMesh && in.geom >= 0 && m.geom_type[in.geom] == mjGEOM_MESH &&
           wants_own_frame(out->materials[static_cast<size_t>(in.material)]);
  };
  for (const InstanceDescription& in : out->instances)
    if (in.shape == ShapeType::kMesh && !is_ours(in)) shared[in.mesh] = true;
  for (InstanceDescription& in : out->instances) {
    if (!is_ours(in)) continue;
    const int asset = m.geom_dataid[in.geom];
    const Affine3f X_AM = rigid_pose(m.mesh_pos + 3 * asset, m.mesh_quat + 4 * asset);
    const auto [entry, added] = restored.try_emplace(in.mesh, in.mesh);
    if (added) {
      if (shared.contains(in.mesh)) {
        entry->second = static_cast<int>(out->meshes.size());
        out->meshes.push_back(out->meshes[static_cast<size_t>(in.mesh)]);
      }
      TriangleMesh& mesh = out->meshes[static_cast<size_t>(entry->second)];
      for (Vec3f& p : mesh.positions) p = transform_point(X_AM, p);
      for (Vec3f& n : mesh.normals) n = transform_vector(X_AM, n);
    }
    in.mesh = entry->second;
    in.X_BG = in.X_BG * inverse(X_AM);
  }
}

}  // namespace gloam
