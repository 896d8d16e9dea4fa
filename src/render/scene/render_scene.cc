#include "render/scene/render_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "base/memory.h"
#include "render/kernel/surface/shapes.h"
#include "render/scene/albedo_table.h"
#include "render/scene/pose.h"
#include "render/scene/span_of.h"
#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

/// Memory that rendering takes beside the description [B]: for a triangle its shading data and its
/// part of the BVH, for a texel its linear value and the smaller levels, for a voxel its part of
/// the majorants.
uint64_t bytes_to_draw(const RenderDescription& d) {
  constexpr uint64_t kTriangle = 250, kTexel = 11, kEnvironment = 24, kVoxel = 4;
  uint64_t bytes = kEnvironment * d.sky.environment.texels.size();
  for (const TriangleMesh& mesh : d.meshes) bytes += kTriangle * mesh.triangle_count();
  for (const DeformableDescription& deformable : d.deformables)
    bytes += kTriangle * deformable.rest.triangle_count();
  for (const TextureDescription& texture : d.textures)
    for (const Image8& face : texture.faces)
      bytes += kTexel * static_cast<uint64_t>(face.width) * static_cast<uint64_t>(face.height);
  for (const VolumeDescription& volume : d.volumes)
    for (const VolumeGrid& grid : {volume.density, volume.temperature})
      if (grid != nullptr) bytes += kVoxel * grid->size();
  return bytes;
}

Status check_references(const RenderDescription& d) {
  const auto bad = [](std::string what) { return Error{ErrorKind::kInput, std::move(what)}; };
  const auto is_texture = [&](int t) { return t >= -1 && t < static_cast<int>(d.textures.size()); };
  for (const MaterialDescription& m : d.materials) {
    for (const int row : {m.pattern, m.wear}) {
      if (row < -1 || row >= static_cast<int>(d.procedurals.size())) {
        return bad(
            fmt::format("material '{}' refers to pattern {}, which does not exist", m.name, row));
      }
    }
    for (const int texture : m.textures.all()) {
      if (!is_texture(texture)) {
        return bad(fmt::format("material '{}' refers to texture {}, which does not exist", m.name,
                               texture));
      }
    }
  }
  for (const MaterialDescription& m : d.materials) {
    if (m.schedule >= static_cast<int>(d.schedules.size())) {
      return bad(fmt::format("material '{}' refers to schedule {}, which does not exist", m.name,
                             m.schedule));
    }
  }
  for (const LightDescription& light : d.lights) {
    if (light.schedule >= static_cast<int>(d.schedules.size()) ||
        light.motion >= static_cast<int>(d.motions.size()) ||
        light.profile >= static_cast<int>(d.ies_profiles.size())) {
      return bad(fmt::format(
          "light '{}' refers to schedule {}, motion {} or profile {}, which does not exist",
          light.name, light.schedule, light.motion, light.profile));
    }
  }
  for (const LightSchedule& schedule : d.schedules) {
    GLOAM_TRY_STATUS(check_schedule(schedule, {}));
  }
  if (!is_texture(d.sky.texture)) return bad("the sky refers to a texture that does not exist");
  if (d.sky.schedule >= static_cast<int>(d.schedules.size()))
    return bad("the sky refers to a schedule that does not exist");
  for (size_t i = 0; i < d.instances.size(); ++i) {
    const InstanceDescription& in = d.instances[i];
    const bool rigid = in.shape == ShapeType::kMesh, soft = in.shape == ShapeType::kDeformable;
    const size_t meshes = soft ? d.deformables.size() : d.meshes.size();
    if ((rigid || soft) && (in.mesh < 0 || static_cast<size_t>(in.mesh) >= meshes)) {
      return bad(fmt::format("drawn geom {} refers to mesh {}, which does not exist", i, in.mesh));
    }
    if (in.motion >= static_cast<int>(d.motions.size()))
      return bad(
          fmt::format("drawn geom {} refers to motion {}, which does not exist", i, in.motion));
    if (in.material < 0 || static_cast<size_t>(in.material) >= d.materials.size()) {
      return bad(
          fmt::format("drawn geom {} refers to material {}, which does not exist", i, in.material));
    }
    const Vec3f s = in.size;
    bool sized = true;
    switch (in.shape) {
      case ShapeType::kBox:
      case ShapeType::kEllipsoid:
        sized = s.x > 0 && s.y > 0 && s.z > 0;
        break;
      case ShapeType::kSphere:
        sized = s.x > 0;
        break;
      case ShapeType::kCapsule:
      case ShapeType::kCylinder:
        sized = s.x > 0 && s.y > 0;
        break;
      case ShapeType::kPlane:
        sized = s.x >= 0 && s.y >= 0;
        break;
      default:
        break;
    }
    if (!sized) return bad(fmt::format("drawn geom {} has a size that is not positive", i));
  }
  return {};
}

/// MuJoCo's ambient light of all lamps that are on, and of the headlight; schedules left out.
Vec3f live_ambient(const RenderDescription& description, const PoseFrame& frame) {
  if (frame.live_serial == 0) return description.sky.ambient;
  Vec3f sum;
  for (const LightDescription& light : description.lights) {
    if (light.light < 0 || frame.light_active[static_cast<size_t>(light.light)] != 0) {
      sum += light.ambient;
    }
  }
  return sum * kWhiteLuminance;
}

float ambient_level(const RenderDescription& description, double time) {
  constexpr uint32_t kAmbient = ~0u;  // no lamp's row
  const int row = description.sky.schedule;
  if (row < 0) return 1;
  return static_cast<float>(light_level(description.schedules[static_cast<size_t>(row)], time,
                                        description.schedule_seed, kAmbient));
}

}  // namespace

Result<std::unique_ptr<RenderScene>> RenderScene::make(const RenderDescription& description) {
  GLOAM_TRY_STATUS(check_memory(bytes_to_draw(description),
                                "drawing the scene's meshes and textures",
                                "use fewer triangles, smaller textures or coarser volumes"));
  GLOAM_TRY_STATUS(check_references(description));
  std::unique_ptr<RenderScene> scene(new RenderScene(description));
  GLOAM_TRY(scene->textures_, make_texture_store(description.textures));
  GLOAM_TRY(scene->meshes_, MeshStore::make(description));
  GLOAM_TRY(scene->volumes_, VolumeStore::make(description.media, description.volumes));
  scene->profiles_ = make_profile_store(description.ies_profiles);
  if (const EnvironmentDescription& map = description.sky.environment; map.width > 0) {
    GLOAM_TRY(scene->environment_,
              EnvironmentTable::make(map.width, map.height, map.texels, map.name));
  }
  fill_albedo_table(&scene->albedo_);
  scene->materials_ = MaterialStore(description, scene->textures_);
  const std::vector<MaterialLayers>& layers = scene->materials_.layers();
  if (std::any_of(layers.begin(), layers.end(),
                  [](const MaterialLayers& m) { return m.transmission > 0 && !m.thin; })) {
    scene->glass_ = std::make_unique<GlassTable>();
    fill_glass_table(scene->glass_.get());
  }
  for (const InstanceDescription& in : description.instances) {
    InstanceView out;
    out.shape = in.shape;
    out.material = static_cast<uint32_t>(in.material);
    out.size = in.size;
    out.color_only = in.color_only;
    out.half_size = shape_half_size(in.shape, in.size);
    if (in.shape == ShapeType::kMesh || in.shape == ShapeType::kDeformable) {
      out.mesh = static_cast<uint32_t>(in.mesh);
      if (in.shape == ShapeType::kDeformable) {
        out.mesh += static_cast<uint32_t>(description.meshes.size());
      }
      out.half_size = scene->meshes_.buffers(out.mesh).half_extents;
    }
    scene->instances_.push_back(out);
  }
  scene->is_height_field_.resize(description.meshes.size());
  for (const HeightFieldDescription& field : description.height_fields) {
    if (field.mesh < 0 || static_cast<size_t>(field.mesh) >= description.meshes.size()) {
      return Error{ErrorKind::kInput, "a height field refers to a mesh that does not exist"};
    }
    scene->is_height_field_[static_cast<size_t>(field.mesh)] = true;
  }
  if (description.sky.day) scene->moving_sky_.emplace(*description.sky.day);
  scene->drawn_.resize(description.instances.size());
  scene->follow_materials();
  scene->mesh_views_ = scene->meshes_.views(description);
  return scene;
}

void RenderScene::follow_materials() {
  bool changed = false;
  for (size_t i = 0; i < instances_.size(); ++i) {
    const InstanceView& in = instances_[i];
    const MaterialView& material = materials_.views()[in.material];
    const bool drawn = description_.instances[i].shown && material.opacity > 0;
    changed |= drawn != drawn_[i];
    drawn_[i] = drawn;
    const bool has_mesh = in.shape == ShapeType::kMesh || in.shape == ShapeType::kDeformable;
    if (has_mesh && drawn && luminance(material.emission) > 0) {
      meshes_.make_samplable(description_, in.mesh);
    }
  }
  if (changed) ++drawn_version_;
}

void RenderScene::follow_live_fields(const PoseFrame& frame) {
  if (materials_.update(description_, textures_, frame, &instances_)) {
    follow_materials();
    mesh_views_ = meshes_.views(description_);
  }
  rebuilt_meshes_.clear();
  if (frame.height_field_serial == height_field_serial_) return;
  height_field_serial_ = frame.height_field_serial;
  for (const HeightFieldDescription& field : description_.height_fields) {
    if (!meshes_.rebuild(description_, field, frame)) continue;
    const auto row = static_cast<uint32_t>(field.mesh);
    rebuilt_meshes_.push_back(row);
    for (InstanceView& instance : instances_) {
      if (instance.shape == ShapeType::kMesh && instance.mesh == row) {
        instance.half_size = meshes_.buffers(row).half_extents;
      }
    }
  }
  mesh_views_ = meshes_.views(description_);
}

void RenderScene::bake_patterns(const PoseFrame& frame) {
  patterns_ = PatternStore::make(description_, frame);
  const std::vector<InstancePatterns>& rows = patterns_->instances();
  for (size_t i = 0; i < rows.size(); ++i) {
    instances_[i].baked_pattern = rows[i].pattern;
    instances_[i].baked_wear = rows[i].wear;
  }
}

void RenderScene::update(std::span<const PoseFrame* const> keys, const PoseFrame& previous) {
  GLOAM_CHECK(!keys.empty(), "there is no key");
  const PoseFrame& open = *keys.front();
  if (!patterns_) bake_patterns(open);
  follow_live_fields(open);
  volumes_.follow(description_.volumes, open);
  time_ = open.time;
  levels_.update(description_, open.time, keys.back()->time);
  if (!description_.schedules.empty()) materials_.dim(description_, levels_.materials());
  sky_ambient_ = live_ambient(description_, open) * ambient_level(description_, time_);
  if (moving_sky_) moving_sky_->update(time_);
  if (!description_.deformables.empty()) {
    meshes_.update(description_, keys, previous);
    mesh_views_ = meshes_.views(description_);
  }
  pose_keys_.clear();
  for (size_t i = 0; i < instances_.size(); ++i) {
    InstanceView& out = instances_[i];
    const InstanceDescription& in = description_.instances[i];
    const auto body = static_cast<size_t>(out.shape == ShapeType::kDeformable ? in.bone : in.body);
    out.snow_left = body < open.snow_left.size() ? open.snow_left[body] : 1;
    if (out.shape == ShapeType::kDeformable) continue;
    out.X_WG = pose_in_world(description_, open, in);
    out.X_WG_previous =
        &open == &previous || in.is_static ? out.X_WG : pose_in_world(description_, previous, in);
    out.has_moved = !is_same(out.X_WG, out.X_WG_previous);
    out.moving = !in.is_static && add_keys(keys, in, out.X_WG);
  }
  const size_t count = keys.size();
  size_t row = 0;
  for (InstanceView& out : instances_) {
    out.keys = {};
    if (out.shape == ShapeType::kDeformable || !out.moving) continue;
    out.keys = {pose_keys_.data() + row, static_cast<uint32_t>(count)};
    row += count;
  }
  lights_.update(description_, keys, levels_.lights(), moving_sky_ ? &moving_sky_->sun() : nullptr,
                 materials_.views(), mesh_views_, &instances_);
}

/// Adds the instance's poses at all keys, if they are not all the same.
bool RenderScene::add_keys(std::span<const PoseFrame* const> keys, const InstanceDescription& in,
                           const Affine3f& X_WG) {
  const size_t first = pose_keys_.size();
  bool moving = false;
  for (const PoseFrame* key : keys) {
    pose_keys_.push_back(key == keys.front() ? X_WG : pose_in_world(description_, *key, in));
    moving |= !is_same(pose_keys_.back(), X_WG);
  }
  if (!moving) pose_keys_.resize(first);
  return moving;
}

EnvironmentView RenderScene::described_environment() const {
  if (!environment_) return {};
  const EnvironmentDescription& map = description_.sky.environment;
  return environment_->view(turned_about_z(map.turn), map.scale);
}

DescribedLook RenderScene::described_look(const PoseFrame& frame) const {
  DescribedLook look;
  look.materials = MaterialStore(description_, textures_).views();
  look.instances = instances_;
  look.lights =
      LightTable::guided(description_, frame, look.materials, mesh_views_, &look.instances);
  look.environment = described_environment();
  look.sky_ambient = description_.sky.ambient;
  return look;
}

bool RenderScene::has_motion() const {
  return !lights_.keys().empty() ||
         std::any_of(instances_.begin(), instances_.end(), [this](const InstanceView& in) {
           return in.shape == ShapeType::kDeformable ? !mesh_views_[in.mesh].position_keys.empty()
                                                     : in.moving;
         });
}

SceneView RenderScene::view_from(const Affine3f& X_WC, std::span<const Affine3f> keys) {
  lights_.place_headlights(X_WC, keys);
  SceneView view;
  view.instances = span_of(instances_);
  view.meshes = span_of(mesh_views_);
  view.materials = span_of(materials_.views());
  view.textures = span_of(textures_.textures);
  view.texture_levels = span_of(textures_.levels);
  view.texels = span_of(textures_.texels);
  view.lights = span_of(lights_.lights());
  view.light_keys = span_of(lights_.keys());
  view.light_key_count = lights_.key_count();
  view.light_levels = span_of(levels_.bins());
  view.light_level_count = levels_.bin_count();
  view.profiles = span_of(profiles_.profiles);
  view.profile_values = span_of(profiles_.values);
  view.media = volumes_.view();
  if (const WeatherDescription& weather = description_.weather; weather.shelter != nullptr)
    view.fallen = {weather.wetness_at(time_), weather.snow_at(time_), static_cast<float>(time_),
                   weather.impacts, weather.shelter->view()};
  view.light_tree = lights_.tree();
  view.selects_by_tree = !view.light_tree.nodes.empty();
  view.procedurals = span_of(description_.procedurals);
  if (patterns_) view.baked = patterns_->view();
  view.layers = span_of(materials_.layers());
  view.albedo = &albedo_;
  view.glass = glass_.get();
  const SkyDescription& sky = description_.sky;
  view.environment = moving_sky_ ? moving_sky_->view() : described_environment();
  view.sky_texture = sky.scale > 0 ? sky.texture : -1;
  view.sky_scale = sky.scale;
  view.sky_ambient = sky_ambient_;
  for (size_t i = 0; i < instances_.size(); ++i) {
    const MaterialView& material = materials_.views()[instances_[i].material];
    if (!is_drawn(i)) continue;
    view.has_transparent |= material.transparent || instances_[i].color_only;
    view.has_color_only |= instances_[i].color_only;
    view.has_emitters |= max_component(material.emission) > 0;
  }
  view.has_visible_lights = lights_.has_visible();
  for (const VolumeDescription& volume : description_.volumes) {
    view.has_emitters |= description_.media[static_cast<size_t>(volume.medium)].emission > 0;
  }
  view.has_emitters |= view.has_visible_lights || view.environment.illuminance > 0 ||
                       view.sky_texture >= 0 || max_component(sky_ambient_) > 0;
  return view;
}

}  // namespace gloam
