#include "world/shapes/visual_site.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "world/model_names.h"
#include "world/shapes/visual_pose.h"
#include "world/world.h"

namespace gloam {
namespace {

// The shapes that a site may have.
std::optional<ShapeType> site_shape(int type) {
  switch (type) {
    case mjGEOM_SPHERE:
      return ShapeType::kSphere;
    case mjGEOM_CAPSULE:
      return ShapeType::kCapsule;
    case mjGEOM_ELLIPSOID:
      return ShapeType::kEllipsoid;
    case mjGEOM_CYLINDER:
      return ShapeType::kCylinder;
    case mjGEOM_BOX:
      return ShapeType::kBox;
    default:
      return std::nullopt;
  }
}

bool never_moves(const mjModel& m, int body) {
  for (; body > 0; body = m.body_parentid[body])
    if (m.body_jntnum[body] > 0 || m.body_mocapid[body] >= 0) return false;
  return true;
}

}  // namespace

bool draws_group(const RenderOptions& render, int group) {
  if (render.groups.empty()) return group < kFirstHiddenGroup;
  return std::ranges::find(render.groups, group) != render.groups.end();
}

void describe_sites(const CompiledWorld& world, MaterialTable* materials, LabelTable* labels,
                    RenderDescription* out) {
  const mjModel& m = *world.model;
  if (!world.scene.render.sites) return;
  for (int i = 0; i < static_cast<int>(m.nsite); ++i) {
    const std::optional<ShapeType> shape = site_shape(m.site_type[i]);
    const float* rgba = m.site_rgba + 4 * i;
    if (!shape || !draws_group(world.scene.render, m.site_group[i]) ||
        drawn_rgba(m, m.site_matid[i], rgba)[3] == 0)
      continue;
    InstanceDescription site;
    site.shape = *shape;
    const mjtNum* size = m.site_size + 3 * i;
    site.size = {static_cast<float>(size[0]), static_cast<float>(size[1]),
                 static_cast<float>(size[2])};
    site.body = m.site_bodyid[i];
    site.X_BG = rigid_pose(m.site_pos + 3 * i, m.site_quat + 4 * i);
    site.material = materials->row(m.site_matid[i], rgba, *shape);
    site.is_static = never_moves(m, site.body);
    site.casts_shadow = false;
    site.color_only = true;
    site.group = m.site_group[i];
    const std::string name = name_of(m, mjOBJ_SITE, i);
    site.label = labels->label(site.body, name, mjOBJ_SITE, i);
    site.label.geom = name;
    site.label.material = out->materials[static_cast<size_t>(site.material)].name;
    site.label.part = static_cast<uint32_t>(out->instances.size()) + 1;
    out->instances.push_back(std::move(site));
  }
}

}  // namespace gloam
