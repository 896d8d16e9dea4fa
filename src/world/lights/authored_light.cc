#include "world/lights/authored_light.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "base/angle.h"
#include "base/text.h"
#include "world/compile/look_at.h"
#include "world/lights/lamp_mesh.h"
#include "world/lights/light_strength.h"
#include "world/shapes/visual_pose.h"
#include "world/world.h"

namespace gloam {
namespace {

Affine3f pose_of(const LightOptions& light) {
  Quat q;
  if (light.orientation) q = *light.orientation;
  if (light.look_at) q = look_at(light.position, *light.look_at);
  const mjtNum p[3] = {light.position.x, light.position.y, light.position.z};
  const mjtNum wxyz[4] = {q.w, q.x, q.y, q.z};
  return rigid_pose(p, wxyz);
}

Result<int> body_of(const mjModel& m, const LightOptions& light) {
  if (light.body.empty()) return 0;
  const int body = mj_name2id(&m, mjOBJ_BODY, light.body.c_str());
  if (body >= 0) return body;
  std::vector<std::string> names;
  for (int i = 0; i < m.nbody; ++i) {
    if (const char* name = mj_id2name(&m, mjOBJ_BODY, i)) names.emplace_back(name);
  }
  return Error{ErrorKind::kInput,
               fmt::format("light '{}': there is no body '{}'", light.name, light.body), light.loc,
               suggest_name(light.body, names)};
}

LightSchedule schedule_of(const LightScheduleOptions& in) {
  LightSchedule out;
  if (in.on_off) out.parts.push_back(OnOff{in.on_off->period, in.on_off->duty, in.on_off->phase});
  if (!in.keys.empty()) {
    Keyframes keys{.keys = {}, .linear = !in.hold};
    for (const LightKeyOptions& key : in.keys) keys.keys.push_back({key.time, key.level});
    out.parts.push_back(std::move(keys));
  }
  if (in.mains) out.parts.push_back(MainsRipple{in.mains->frequency, in.mains->depth});
  if (in.starter) out.parts.push_back(FluorescentStart{in.starter->at, in.starter->warm_up});
  if (in.flame) out.parts.push_back(Flame{in.flame->bandwidth, in.flame->depth});
  return out;
}

LampMotion motion_of(const LightOptions& light) {
  const LightMotionOptions& in = *light.motion;
  const Vec3 axis = in.axis.value_or(in.spin ? Vec3{0, 0, 1} : Vec3{1, 0, 0});
  const double cord = in.sway ? in.cord.value_or(1) : 0;  // [m]
  LampMotion out;
  const double length = std::hypot(axis.x, axis.y, axis.z);
  out.axis = {static_cast<float>(axis.x / length), static_cast<float>(axis.y / length),
              static_cast<float>(axis.z / length)};
  out.pivot = pose_of(light).p + Vec3f{0, 0, static_cast<float>(cord)};
  out.phase = in.phase;
  out.turns = in.spin.value_or(0) / 60;
  if (in.sway) {
    out.swing = *in.sway * kDegree;
    out.swing_rate = pendulum_rate(cord);
  }
  return out;
}

/// Illuminance that an area gives at `distance`, at most that right in front of it [lx].
float area_illuminance(double luminance, double area, bool is_flat, float distance) {
  // Mean shadow of convex shapes over all directions (Cauchy)
  const double shown = is_flat ? area : area / 4;
  return static_cast<float>(luminance * std::min(M_PI, shown / sqr(distance)));
}

/// Place of a lamp and the rows of its changes.
struct LampPlace {
  int body = 0, schedule = -1, motion = -1;  ///< the latter two: rows, -1 = none
  bool is_static = true;
  float distance = 1;  ///< to its target [m]
};

class LightAuthor {
 public:
  LightAuthor(const CompiledWorld& world, const std::vector<Affine3f>& poses,
              const std::vector<bool>& is_static, LabelTable* labels, LightLevels* levels,
              RenderDescription* out)
      : world_(world),
        poses_(poses),
        is_static_(is_static),
        labels_(labels),
        levels_(levels),
        out_(out) {}

  Status add(const LightOptions& options);

 private:
  Status add_lamp(const LightOptions& options, const LampPlace& place);
  Status add_area(const LightOptions& options, const LampPlace& place);
  Result<int> profile_row(const LightOptions& options);
  Result<int> mesh_row(const LightOptions& options);

  const CompiledWorld& world_;
  const std::vector<Affine3f>& poses_;
  const std::vector<bool>& is_static_;
  LabelTable* labels_;
  LightLevels* levels_;
  RenderDescription* out_;
  std::map<std::filesystem::path, int> profiles_, meshes_;  ///< rows of files already read
  int count_ = 0;
};

/// Errors of files have their own location or none; the scene's line identifies the lamp.
Error in_light(Error error, const LightOptions& light) {
  error.message = fmt::format("light '{}': {}", light.name, error.to_string());
  error.loc = light.loc;
  error.hint.clear();
  return error;
}

Result<int> LightAuthor::profile_row(const LightOptions& options) {
  if (options.ies.empty()) return -1;
  if (const auto known = profiles_.find(options.ies); known != profiles_.end())
    return known->second;
  Result<IesProfile> profile = read_ies(options.ies);
  if (!profile.ok()) return in_light(std::move(profile).error(), options);
  if (!(profile->most > 0 && profile->flux > 0)) {
    return Error{ErrorKind::kInput,
                 fmt::format("light '{}': '{}' emits no light in any direction", options.name,
                             options.ies.filename().string()),
                 options.loc};
  }
  const int row = static_cast<int>(out_->ies_profiles.size());
  out_->ies_profiles.push_back(std::move(profile).value());
  profiles_.emplace(options.ies, row);
  return row;
}

Result<int> LightAuthor::mesh_row(const LightOptions& options) {
  const bool is_file = options.type == LightType::kMesh;
  if (is_file) {
    if (const auto known = meshes_.find(options.file); known != meshes_.end()) return known->second;
  }
  TriangleMesh mesh;
  if (is_file) {
    Result<TriangleMesh> read = read_lamp(options.file);
    if (!read.ok()) return in_light(std::move(read).error(), options);
    mesh = std::move(read).value();
  } else {
    mesh = options.type == LightType::kRect ? rect_lamp((*options.size)[0], (*options.size)[1])
                                            : disk_lamp(*options.radius);
  }
  const int row = static_cast<int>(out_->meshes.size());
  out_->meshes.push_back(std::move(mesh));
  if (is_file) meshes_.emplace(options.file, row);
  return row;
}

Status LightAuthor::add_lamp(const LightOptions& options, const LampPlace& place) {
  LightDescription light;
  light.name = options.name;
  light.body = place.body;
  light.X_BL = pose_of(options);
  light.is_static = place.is_static;
  light.casts_shadow = options.casts_shadow;
  light.schedule = place.schedule;
  light.motion = place.motion;
  const Vec3f color = light_color(options);
  if (options.type == LightType::kDirectional) {
    light.type = PunctualLightType::kDirectional;
    light.radius = static_cast<float>(std::sin(options.angle.value_or(0) / 2 * kDegree));
    light.intensity = color * static_cast<float>(*options.illuminance);
    levels_->illuminance.push_back(luminance(light.intensity));
  } else {
    light.radius = static_cast<float>(options.radius.value_or(0));
    if (options.type == LightType::kSpot) {
      constexpr double kDefaultConeAngle = 45;  // [deg]
      light.type = PunctualLightType::kSpot;
      light.cos_cutoff =
          static_cast<float>(std::cos(options.angle.value_or(kDefaultConeAngle) * kDegree));
      light.softness = static_cast<float>(options.softness.value_or(0));
    }
    GLOAM_TRY(light.profile, profile_row(options));
    const IesProfile* profile =
        light.profile >= 0 ? &out_->ies_profiles[static_cast<size_t>(light.profile)] : nullptr;
    light.intensity = color * static_cast<float>(candela(options, light, profile));
    levels_->illuminance.push_back(luminance(light.intensity) / sqr(place.distance));
  }
  out_->lights.push_back(std::move(light));
  return {};
}

Status LightAuthor::add_area(const LightOptions& options, const LampPlace& place) {
  const bool is_sphere = options.type == LightType::kSphere;
  InstanceDescription instance;
  double area = 0;
  if (is_sphere) {
    const auto radius = static_cast<float>(*options.radius);
    instance.shape = ShapeType::kSphere;
    instance.size = {radius, radius, radius};
    area = 4 * M_PI * *options.radius * *options.radius;
  } else {
    instance.shape = ShapeType::kMesh;
    instance.size = {1, 1, 1};
    GLOAM_TRY(instance.mesh, mesh_row(options));
    area = area_of(out_->meshes[static_cast<size_t>(instance.mesh)]);
  }
  // It reflects nothing: its luminance is the specified value.
  MaterialDescription material;
  material.name = options.name;
  material.base_color = {0, 0, 0};
  material.specular_weight = 0;
  material.rgba = {0, 0, 0, 1};
  const double shown = area_luminance(options, area);
  material.emission = light_color(options) * static_cast<float>(shown);
  material.emits_outwards = !is_sphere;
  material.schedule = place.schedule;
  levels_->illuminance.push_back(area_illuminance(
      shown, area, options.type == LightType::kRect || options.type == LightType::kDisk,
      place.distance));

  instance.body = place.body;
  instance.X_BG = pose_of(options);
  instance.motion = place.motion;
  instance.is_static = place.is_static;
  instance.material = static_cast<int>(out_->materials.size());
  instance.label = labels_->label(place.body, options.name, mjOBJ_LIGHT, count_);
  instance.label.geom = options.name;
  instance.label.material = options.name;
  instance.label.part = static_cast<uint32_t>(out_->instances.size()) + 1;
  out_->materials.push_back(std::move(material));
  out_->instances.push_back(std::move(instance));
  return {};
}

Status LightAuthor::add(const LightOptions& options) {
  LampPlace place;
  GLOAM_TRY(place.body, body_of(*world_.model, options));
  const auto body = static_cast<size_t>(place.body);
  if (options.schedule) {
    LightSchedule parts = schedule_of(*options.schedule);
    SourceLoc loc = options.schedule->loc;
    if (loc.file.empty()) loc = options.loc;
    GLOAM_TRY_STATUS(check_schedule(parts, loc));
    place.schedule = static_cast<int>(out_->schedules.size());
    out_->schedules.push_back(std::move(parts));
  }
  if (options.motion) {
    place.motion = static_cast<int>(out_->motions.size());
    out_->motions.push_back(motion_of(options));
  }
  place.is_static = is_static_[body] && !options.motion;
  const Vec3f p_W = transform_point(poses_[body], pose_of(options).p);
  // A lamp that is carried about shines ahead, not at the middle of who carries it.
  constexpr float kCarriedAimDistance = 2;  // [m]
  place.distance = light_distance(p_W, *out_);
  if (!is_static_[body]) place.distance = max(place.distance, kCarriedAimDistance);
  GLOAM_TRY_STATUS(is_area_light(*options.type) ? add_area(options, place)
                                                : add_lamp(options, place));
  ++count_;
  return {};
}

}  // namespace

Status author_lights(const CompiledWorld& world, const std::vector<Affine3f>& poses,
                     const std::vector<bool>& is_static, LabelTable* labels, LightLevels* levels,
                     RenderDescription* out) {
  out->schedule_seed = world.scene.sim.seed;
  LightAuthor author(world, poses, is_static, labels, levels, out);
  for (const LightOptions& light : world.scene.lights) GLOAM_TRY_STATUS(author.add(light));
  return {};
}

}  // namespace gloam
