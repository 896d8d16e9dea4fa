#include "world/render_description.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "base/parallel.h"
#include "places/generators.h"
#include "world/authored_frame.h"
#include "world/effects/surface_layout.h"
#include "world/effects/visual_soil.h"
#include "world/effects/visual_water.h"
#include "world/lights/authored_light.h"
#include "world/lights/blackout.h"
#include "world/lights/visual_light.h"
#include "world/materials/authored_material.h"
#include "world/materials/visual_material.h"
#include "world/media/authored_volume.h"
#include "world/model_names.h"
#include "world/sensors/visual_camera.h"
#include "world/shapes/deformable_layout.h"
#include "world/shapes/drawn_points.h"
#include "world/shapes/visual_deformable.h"
#include "world/shapes/visual_file.h"
#include "world/shapes/visual_mesh.h"
#include "world/shapes/visual_pose.h"
#include "world/shapes/visual_site.h"
#include "world/sky/authored_sky.h"
#include "world/view/free_view.h"
#include "world/view/render_origin.h"
#include "world/view/studio.h"
#include "world/visual_label.h"
#include "world/world.h"

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

/// Geoms of one model on their way into the description. Meshes are handed out as rows first and
/// converted together at the end, in parallel.
class GeomImporter {
 public:
  GeomImporter(const mjModel& model, bool live, RenderDescription* out)
      : model_(model), live_(live), materials_(model, live, out), out_(out) {}

  /// The geom's shape, material and flags; nothing when it cannot be seen.
  std::optional<InstanceDescription> instance(int geom);
  /// Row of the material that a mesh in the geom's place has.
  int mesh_material(int geom) {
    return materials_.row(model_.geom_matid[geom], model_.geom_rgba + 4 * geom, ShapeType::kMesh);
  }
  void convert_meshes();
  MaterialTable& materials() { return materials_; }

 private:
  int mesh_row(int asset, bool is_height_field);

  struct PendingMesh {
    int asset = 0, row = 0, height_field = -1;
  };
  const mjModel& model_;
  const bool live_;
  MaterialTable materials_;
  RenderDescription* out_;
  std::map<std::pair<int, bool>, int> mesh_rows_;
  std::vector<PendingMesh> pending_;
};

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

/// Flags of the bodies that can never move.
std::vector<bool> static_bodies(const mjModel& m) {
  std::vector<bool> is_static(static_cast<size_t>(m.nbody), true);
  for (size_t b = 1; b < is_static.size(); ++b)
    is_static[b] = m.body_jntnum[b] == 0 && m.body_mocapid[b] < 0 &&
                   is_static[static_cast<size_t>(m.body_parentid[b])];
  return is_static;
}

/// Robots collide with simpler shapes than they show. In MJCF those are in the groups 3 and up,
/// which MuJoCo hides; in a URDF they are the geoms of the model, and the visuals, where a link has
/// some, are `instances` from `first_visual` on. Something that moves on joints and has nothing to
/// show shows what it collides with. The scene's visuals, from `first_file` on, count as shown and
/// take nothing else's place.
void choose_what_is_shown(const mjModel& m, const CompiledWorld& world, size_t first_visual,
                          size_t first_file, std::vector<InstanceDescription>* instances) {
  const auto body_of = [&](size_t i) { return static_cast<size_t>((*instances)[i].body); };
  const auto root_of = [&](size_t i) { return static_cast<size_t>(m.body_rootid[body_of(i)]); };
  std::vector<bool> has_visuals(static_cast<size_t>(m.nbody)), root_shows(has_visuals);
  for (size_t i = first_visual; i < instances->size(); ++i) {
    // The world's own geoms are the scene's, unless the robot stands alone.
    if (i < first_file && (body_of(i) > 0 || !world.scene.bare_model.empty()))
      has_visuals[body_of(i)] = true;
    root_shows[root_of(i)] = true;
  }
  const RenderOptions& render = world.scene.render;
  if (!render.groups.empty()) {
    for (size_t i = 0; i < first_file; ++i)
      (*instances)[i].shown = draws_group(render, (*instances)[i].group);
    return;
  }
  for (size_t i = 0; i < first_visual; ++i) {
    InstanceDescription& instance = (*instances)[i];
    instance.shown = instance.group < kFirstHiddenGroup && !has_visuals[body_of(i)];
    if (instance.shown) root_shows[root_of(i)] = true;
  }
  std::vector<bool> root_moves(static_cast<size_t>(m.nbody));
  for (int body = 1; body < m.nbody; ++body) {
    if (m.body_jntnum[body] > 0) root_moves[static_cast<size_t>(m.body_rootid[body])] = true;
  }
  for (size_t i = 0; i < first_visual; ++i)
    if (root_moves[root_of(i)] && !root_shows[root_of(i)]) (*instances)[i].shown = true;
}

/// The model, or where it has nothing to draw, the scene's visuals at qpos0. `out` holds them.
Framing framing_of(const mjModel& m, const std::vector<Affine3f>& poses, size_t first_file,
                   const RenderDescription& out) {
  const auto& center = m.stat.center;
  const Framing model{{center[0], center[1], center[2]}, m.stat.extent};
  const bool has_own = first_file > 0 || m.nflex > 0 || m.nskin > 0;
  if (has_own || out.instances.empty()) return model;
  constexpr float kFar = 1e30f;
  Vec3f low{kFar, kFar, kFar}, high = -low;
  for (const InstanceDescription& in : out.instances) {
    const Affine3f X_WG = poses[static_cast<size_t>(in.body)] * in.X_BG;
    for (const Vec3f& p_G : out.meshes[static_cast<size_t>(in.mesh)].positions) {
      const Vec3f p = transform_point(X_WG, p_G);
      low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
      high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
    }
  }
  const Vec3f middle = (low + high) * 0.5f;
  return {{middle.x, middle.y, middle.z}, max(length(high - low), 1e-3f)};
}

/// A model without a place around it: the free camera frames it, and the studio lights it where it
/// brings no light.
void present_model(const CompiledWorld& world, RenderDescription* out) {
  const Scene& scene = world.scene;
  const EnvironmentOptions& place = scene.environment;
  if (scene.render.look == "model" || !place.file.empty() || has_generator(place)) return;
  const mjModel& m = *world.model;
  const std::vector<DrawnPart> all = drawn_parts(*out, body_poses_at_start(world));
  const std::vector<DrawnPart> subject =
      subject_of(all, *out, {m.body_rootid, static_cast<size_t>(m.nbody)});
  CameraDescription& free = out->cameras.back();
  frame_subject(subject, free_direction(m), steepest_elevation(m), &free);
  free.near = 0;  // it stands where nothing is in its way
  free.culls_backs = false;
  if (needs_studio(scene, *out)) return add_studio(subject, all, free.X_WC, out);
  const bool own_light = !scene.lights.empty() || scene.sky;  // light of the scene, in real units
  if (scene.render.look == "auto" && !own_light) open_exposure(subject, free.X_WC, out);
}

}  // namespace

namespace {

Result<RenderDescription> describe_from_origin(const CompiledWorld& world) {
  const mjModel& m = *world.model;
  RenderDescription out;
  out.center = {static_cast<float>(m.stat.center[0]), static_cast<float>(m.stat.center[1]),
                static_cast<float>(m.stat.center[2])};
  out.extent = static_cast<float>(m.stat.extent);
  LabelTable labels(world);
  const std::vector<Affine3f> poses = body_poses_at_qpos0(m);
  const std::vector<bool> is_static = static_bodies(m);

  const auto add = [&](InstanceDescription instance, int body, std::string name, int kind, int id) {
    instance.body = body;
    instance.is_static = is_static[static_cast<size_t>(body)];
    instance.label = labels.label(body, name, kind, id);
    instance.label.geom = name.empty() && kind == mjOBJ_GEOM ? geom_label(m, id) : std::move(name);
    instance.label.material = out.materials[static_cast<size_t>(instance.material)].name;
    instance.label.part = static_cast<uint32_t>(out.instances.size()) + 1;
    out.instances.push_back(std::move(instance));
  };

  GeomImporter simulated(m, true, &out);
  out.instances.reserve(static_cast<size_t>(m.ngeom) + world.visual_only.size());
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g)
    if (auto instance = simulated.instance(g))
      add(std::move(*instance), m.geom_bodyid[g], name_of(m, mjOBJ_GEOM, g), mjOBJ_GEOM, g);

  const size_t first_visual = out.instances.size();
  std::optional<GeomImporter> visual;
  constexpr int kVisualOnly = mjOBJ_UNKNOWN;
  std::vector<DrawnMesh> meshes;
  if (world.visual_model != nullptr) {
    visual.emplace(*world.visual_model, false, &out);
    for (size_t i = 0; i < world.visual_only.size(); ++i) {
      const VisualOnlyGeom& geom = world.visual_only[i];
      auto instance = visual->instance(geom.geom);
      if (!instance) continue;
      if (geom.mesh >= 0) {
        meshes.push_back({static_cast<int>(i), visual->mesh_material(geom.geom)});
        continue;
      }
      const mjtNum p[3] = {geom.X_BG.p.x, geom.X_BG.p.y, geom.X_BG.p.z};
      const mjtNum q[4] = {geom.X_BG.q.w, geom.X_BG.q.x, geom.X_BG.q.y, geom.X_BG.q.z};
      instance->X_BG = rigid_pose(p, q);
      add(std::move(*instance), geom.body, name_of(*world.visual_model, mjOBJ_GEOM, geom.geom),
          kVisualOnly, static_cast<int>(i));
    }
  }

  const auto add_mesh = [&](InstanceDescription instance, int body, int index) {
    const int mesh = world.visual_only[static_cast<size_t>(index)].mesh;
    add(std::move(instance), body, world.visual_meshes[static_cast<size_t>(mesh)].label,
        kVisualOnly, index);
  };
  GLOAM_TRY_STATUS(describe_model_meshes(world, meshes, poses, add_mesh, &out));

  const size_t first_file = out.instances.size();
  LightLevels levels;
  const auto add_part = [&](InstanceDescription instance, int body, std::string name, int visual,
                            const std::string& visual_name) {
    constexpr int kVisualFile = -3;
    add(std::move(instance), body, visual_name, kVisualFile, visual);
    out.instances.back().label.geom = std::move(name);
  };
  GLOAM_TRY_STATUS(describe_visuals(world, poses, add_part, &levels, &out));
  const Framing framing = framing_of(m, poses, first_file, out);
  choose_what_is_shown(m, world, first_visual, first_file, &out.instances);
  const size_t first_deformable = out.instances.size();
  describe_deformables(m, poses, &simulated.materials(), &labels, &out);
  for (size_t i = first_deformable; i < out.instances.size(); ++i)
    out.instances[i].shown = draws_group(world.scene.render, out.instances[i].group);
  describe_sites(world, &simulated.materials(), &labels, &out);
  describe_cameras(m, framing, &out);
  for (CameraDescription& camera : out.cameras) {
    for (const CameraOptions& options : world.scene.cameras) {
      if (options.name == camera.name) camera.sensing = options.sensing;
    }
  }
  GLOAM_TRY_STATUS(set_optics(world.scene, &out.cameras));
  levels = describe_light(m, world.scene, poses, std::move(levels), &simulated.materials(), &out);
  out.center = {static_cast<float>(framing.center.x), static_cast<float>(framing.center.y),
                static_cast<float>(framing.center.z)};
  out.extent = static_cast<float>(framing.extent);
  for (LightDescription& light : out.lights) {
    if (light.body >= 0)
      light.is_static = is_static[static_cast<size_t>(light.body)];
    else
      light.is_static = light.light >= 0 && m.light_mode[light.light] == mjCAMLIGHT_FIXED &&
                        is_static[static_cast<size_t>(m.light_bodyid[light.light])];
  }
  simulated.convert_meshes();
  simulated.materials().load_textures();
  if (visual) {
    visual->convert_meshes();
    visual->materials().load_textures();
  }
  // Before the scene's materials, which may be theirs.
  author_soils(world.soils, first_soil_vertex(world), &labels, &out);
  GLOAM_TRY_STATUS(author_materials(world.scene.materials, &out));
  restore_authored_frames(m, &out);
  GLOAM_TRY_STATUS(author_lights(world, poses, is_static, &labels, &levels, &out));
  author_waters(world.waters, first_water_vertex(world), &labels, &out);
  if (world.scene.sky) GLOAM_TRY_STATUS(author_sky(*world.scene.sky, &levels, &out));
  if (world.scene.blackout) GLOAM_TRY_STATUS(author_blackout(*world.scene.blackout, &out));
  GLOAM_TRY_STATUS(author_volumes(world.scene.volumes, &out));
  author_gases(world.gases.gases, &out);
  if (world.scene.weather)
    GLOAM_TRY_STATUS(author_weather(*world.scene.weather, world.wind, world.regions, poses, &out));
  out.ev100 = world.ev100 ? static_cast<float>(*world.ev100) : exposure(levels, out);
  GLOAM_TRY_STATUS(set_clips(world, &out));
  present_model(world, &out);
  return out;
}

}  // namespace

Result<RenderDescription> describe_for_rendering(const CompiledWorld& world) {
  if (is_zero(world.render_origin)) return describe_from_origin(world);
  GLOAM_TRY(const std::unique_ptr<CompiledWorld> moved, moved_world(world));
  GLOAM_TRY(RenderDescription out, describe_from_origin(*moved));
  out.origin = world.render_origin;
  return out;
}

}  // namespace gloam
