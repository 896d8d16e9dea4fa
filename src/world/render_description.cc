#include "world/render_description.h"

#include <optional>

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
#include "world/shapes/geom_importer.h"
#include "world/shapes/visual_deformable.h"
#include "world/shapes/visual_file.h"
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
  if (scene.render.look == RenderLook::kModel || !place.file.empty() || has_generator(place))
    return;
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
  if (scene.render.look == RenderLook::kAuto && !own_light) open_exposure(subject, free.X_WC, out);
}

/// Steps of the description of a World whose render origin is the world's. Their order is that of
/// the rows in the tables.
class RenderDescriber {
 public:
  explicit RenderDescriber(const CompiledWorld& world)
      : world_(world),
        m_(*world.model),
        labels_(world),
        poses_(body_poses_at_qpos0(m_)),
        is_static_(static_bodies(m_)),
        simulated_(m_, true, &out_) {}
  RenderDescriber(const RenderDescriber&) = delete;
  RenderDescriber& operator=(const RenderDescriber&) = delete;

  Result<RenderDescription> describe();

 private:
  void add(InstanceDescription instance, int body, std::string name, int kind, int id);
  void add_geoms();
  Status add_visual_only();
  Status add_files();
  Status add_cameras(const Framing& framing);
  void mark_static_lights();
  void convert();
  Status author();

  static constexpr int kVisualOnly = mjOBJ_UNKNOWN;
  const CompiledWorld& world_;
  const mjModel& m_;
  RenderDescription out_;
  LabelTable labels_;
  const std::vector<Affine3f> poses_;  // of bodies at qpos0
  const std::vector<bool> is_static_;  // by body
  GeomImporter simulated_;
  std::optional<GeomImporter> visual_;
  size_t first_visual_ = 0, first_file_ = 0;  // instances
  LightLevels levels_;
};

void RenderDescriber::add(InstanceDescription instance, int body, std::string name, int kind,
                          int id) {
  instance.body = body;
  instance.is_static = is_static_[static_cast<size_t>(body)];
  instance.label = labels_.label(body, name, kind, id);
  instance.label.geom = name.empty() && kind == mjOBJ_GEOM ? geom_label(m_, id) : std::move(name);
  instance.label.material = out_.materials[static_cast<size_t>(instance.material)].name;
  instance.label.part = static_cast<uint32_t>(out_.instances.size()) + 1;
  out_.instances.push_back(std::move(instance));
}

void RenderDescriber::add_geoms() {
  out_.instances.reserve(static_cast<size_t>(m_.ngeom) + world_.visual_only.size());
  for (int g = 0; g < static_cast<int>(m_.ngeom); ++g)
    if (auto instance = simulated_.instance(g))
      add(std::move(*instance), m_.geom_bodyid[g], name_of(m_, mjOBJ_GEOM, g), mjOBJ_GEOM, g);
  first_visual_ = out_.instances.size();
}

Status RenderDescriber::add_visual_only() {
  std::vector<DrawnMesh> meshes;
  if (world_.visual_model != nullptr) {
    visual_.emplace(*world_.visual_model, false, &out_);
    for (size_t i = 0; i < world_.visual_only.size(); ++i) {
      const VisualOnlyGeom& geom = world_.visual_only[i];
      auto instance = visual_->instance(geom.geom);
      if (!instance) continue;
      if (geom.mesh >= 0) {
        meshes.push_back({static_cast<int>(i), visual_->mesh_material(geom.geom)});
        continue;
      }
      const mjtNum p[3] = {geom.X_BG.p.x, geom.X_BG.p.y, geom.X_BG.p.z};
      const mjtNum q[4] = {geom.X_BG.q.w, geom.X_BG.q.x, geom.X_BG.q.y, geom.X_BG.q.z};
      instance->X_BG = rigid_pose(p, q);
      add(std::move(*instance), geom.body, name_of(*world_.visual_model, mjOBJ_GEOM, geom.geom),
          kVisualOnly, static_cast<int>(i));
    }
  }
  const auto add_mesh = [&](InstanceDescription instance, int body, int index) {
    const int mesh = world_.visual_only[static_cast<size_t>(index)].mesh;
    add(std::move(instance), body, world_.visual_meshes[static_cast<size_t>(mesh)].label,
        kVisualOnly, index);
  };
  GLOAM_TRY_STATUS(describe_model_meshes(world_, meshes, poses_, add_mesh, &out_));
  first_file_ = out_.instances.size();
  return {};
}

Status RenderDescriber::add_files() {
  const auto add_part = [&](InstanceDescription instance, int body, std::string name, int visual,
                            const std::string& visual_name) {
    constexpr int kVisualFile = -3;
    add(std::move(instance), body, visual_name, kVisualFile, visual);
    out_.instances.back().label.geom = std::move(name);
  };
  return describe_visuals(world_, poses_, add_part, &levels_, &out_);
}

Status RenderDescriber::add_cameras(const Framing& framing) {
  describe_cameras(m_, framing, &out_);
  for (CameraDescription& camera : out_.cameras) {
    for (const CameraOptions& options : world_.scene.cameras) {
      if (options.name == camera.name) camera.sensing = options.sensing;
    }
  }
  return set_optics(world_.scene, &out_.cameras);
}

void RenderDescriber::mark_static_lights() {
  for (LightDescription& light : out_.lights) {
    if (light.body >= 0)
      light.is_static = is_static_[static_cast<size_t>(light.body)];
    else
      light.is_static = light.light >= 0 && m_.light_mode[light.light] == mjCAMLIGHT_FIXED &&
                        is_static_[static_cast<size_t>(m_.light_bodyid[light.light])];
  }
}

void RenderDescriber::convert() {
  simulated_.convert_meshes();
  simulated_.materials().load_textures();
  if (visual_) {
    visual_->convert_meshes();
    visual_->materials().load_textures();
  }
}

/// Adds what the scene defines itself.
Status RenderDescriber::author() {
  const Scene& scene = world_.scene;
  // Soils come before the scene's materials, which may be theirs.
  author_soils(world_.soils, first_soil_vertex(world_), &labels_, &out_);
  GLOAM_TRY_STATUS(author_materials(scene.materials, &out_));
  restore_authored_frames(m_, &out_);
  GLOAM_TRY_STATUS(author_lights(world_, poses_, is_static_, &labels_, &levels_, &out_));
  author_waters(world_.waters, first_water_vertex(world_), &labels_, &out_);
  if (scene.sky) GLOAM_TRY_STATUS(author_sky(*scene.sky, &levels_, &out_));
  if (scene.blackout) GLOAM_TRY_STATUS(author_blackout(*scene.blackout, &out_));
  GLOAM_TRY_STATUS(author_volumes(scene.volumes, &out_));
  author_gases(world_.gases.gases, &out_);
  if (scene.weather)
    GLOAM_TRY_STATUS(author_weather(*scene.weather, world_.wind, world_.regions, poses_, &out_));
  return {};
}

Result<RenderDescription> RenderDescriber::describe() {
  out_.center = {static_cast<float>(m_.stat.center[0]), static_cast<float>(m_.stat.center[1]),
                 static_cast<float>(m_.stat.center[2])};
  out_.extent = static_cast<float>(m_.stat.extent);
  add_geoms();
  GLOAM_TRY_STATUS(add_visual_only());
  GLOAM_TRY_STATUS(add_files());
  const Framing framing = framing_of(m_, poses_, first_file_, out_);
  choose_what_is_shown(m_, world_, first_visual_, first_file_, &out_.instances);
  const size_t first_deformable = out_.instances.size();
  describe_deformables(m_, poses_, &simulated_.materials(), &labels_, &out_);
  for (size_t i = first_deformable; i < out_.instances.size(); ++i)
    out_.instances[i].shown = draws_group(world_.scene.render, out_.instances[i].group);
  describe_sites(world_, &simulated_.materials(), &labels_, &out_);
  GLOAM_TRY_STATUS(add_cameras(framing));
  levels_ =
      describe_light(m_, world_.scene, poses_, std::move(levels_), &simulated_.materials(), &out_);
  out_.center = {static_cast<float>(framing.center.x), static_cast<float>(framing.center.y),
                 static_cast<float>(framing.center.z)};
  out_.extent = static_cast<float>(framing.extent);
  mark_static_lights();
  convert();
  GLOAM_TRY_STATUS(author());
  out_.ev100 = world_.ev100 ? static_cast<float>(*world_.ev100) : exposure(levels_, out_);
  GLOAM_TRY_STATUS(set_clips(world_, &out_));
  present_model(world_, &out_);
  return std::move(out_);
}

Result<RenderDescription> describe_from_origin(const CompiledWorld& world) {
  return RenderDescriber(world).describe();
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
