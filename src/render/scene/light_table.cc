#include "render/scene/light_table.h"

#include <algorithm>

#include "render/kernel/shapes.h"
#include "render/scene/pose.h"
#include "world/visual_rules.h"

namespace gloam {
namespace {

/// Power that a light brings into the scene [lm], to weigh lights against each other.
float light_power(const LightView& light, float scene_radius) {
  const float strength = luminance(light.intensity);
  if (light.kind == LightKind::kDirectional) return strength * kPi * scene_radius * scene_radius;
  return strength * 2 * kPi * (1.0f - light.cos_cutoff);
}

bool is_headlight(const LightDescription& light) { return light.light < 0 && light.body < 0; }

LightView describe_light(const LightDescription& in) {
  LightView out;
  out.kind = in.type == LightType::kPoint  ? LightKind::kPoint
             : in.type == LightType::kSpot ? LightKind::kSpot
                                           : LightKind::kDirectional;
  out.casts_shadow = in.casts_shadow;
  out.intensity = in.intensity;
  out.radius = max(in.radius, 0.0f);
  out.profile = in.profile;
  out.is_delta = out.radius <= 0;
  if (out.kind == LightKind::kSpot) {
    out.cos_cutoff = clamp(in.cos_cutoff, -1.0f, 1.0f);
    out.cutoff = std::acos(out.cos_cutoff);
    out.inner = out.cutoff * (1.0f - clamp(in.softness, 0.0f, 1.0f));
    out.cos_inner = std::cos(out.inner);
  }
  return out;
}

/// A sphere that holds the emitter during the shutter.
void set_bounds(const InstanceView& instance, const std::vector<MeshView>& meshes,
                LightView* light) {
  light->p = (instance.X_WG.p + instance.X_WG_close.p) * 0.5f;
  const bool soft = instance.shape == ShapeType::kDeformable;
  if (soft || instance.shape == ShapeType::kMesh) {
    const MeshView& mesh = meshes[instance.mesh];
    if (soft) light->p = mesh.positions.empty() ? Vec3f{} : mesh.positions[0];
    for (uint32_t i = 0; i < mesh.positions.size; ++i) {
      light->reach = max(light->reach, length(mesh.positions[i] - (soft ? light->p : Vec3f{})));
    }
    if (!mesh.positions_close.empty()) light->reach *= 2;
  } else {
    const Vec3f h = shape_half_size(instance.shape, instance.size);
    light->reach = length(h) + (instance.shape == ShapeType::kCapsule ? instance.size.x : 0.0f);
  }
  light->reach += 0.5f * length(instance.X_WG_close.p - instance.X_WG.p);
}

// The guide's rows are those of the description, whatever is live: it is built once.
bool is_guided(const LightDescription& light) {
  return light.is_static && light.casts_shadow && !is_headlight(light);
}
bool is_guided(const RenderDescription& description, const InstanceDescription& instance) {
  const MaterialDescription& material =
      description.materials[static_cast<size_t>(instance.material)];
  return instance.is_static && instance.shown && luminance(material.emission) > 0 &&
         material.opacity > 0;
}

Vec3f row(const std::vector<double>& values, int i) {
  return {static_cast<float>(values[3 * i]), static_cast<float>(values[3 * i + 1]),
          static_cast<float>(values[3 * i + 2])};
}

/// Puts a lamp where the frame has it; the headlight stays where it is.
void place(const LightDescription& in, const PoseFrame& frame, LightView* light) {
  if (in.light >= 0) {
    light->p = row(frame.light_p, in.light);
    light->direction = normalize(row(frame.light_dir, in.light));
    light->x = Frame::from_z(-light->direction).x;
  } else if (in.body >= 0) {
    const Affine3f X_WL = pose_in_world(frame, in.body, in.X_BL);
    light->p = X_WL.p;
    light->direction = -normalize(X_WL.z);
    light->x = normalize(X_WL.x);
  }
}

}  // namespace

void LightTable::update(const RenderDescription& description, const PoseFrame& frame,
                        const std::vector<float>& levels,
                        const std::vector<MaterialView>& materials,
                        const std::vector<MeshView>& meshes, std::vector<InstanceView>* instances) {
  const bool live = frame.live_serial != 0;
  lights_.clear();
  headlights_.clear();
  std::vector<float> power;
  const float scene_radius = max(description.extent, 1.0f);
  int guide = 0;
  size_t row_of_light = 0;
  for (const LightDescription& in : description.lights) {
    const int row_of_guide = is_guided(in) ? guide++ : -1;
    const float level = levels[row_of_light++];
    const bool follows = live && in.light >= 0;
    const size_t i = follows ? static_cast<size_t>(in.light) : 0;
    if (follows ? frame.light_active[i] == 0 : !in.active) continue;
    LightView light = describe_light(in);
    light.guide = row_of_guide;
    place(in, frame, &light);
    if (follows) {
      const float* diffuse = &frame.light_diffuse[3 * i];
      light.intensity = light_intensity({diffuse[0], diffuse[1], diffuse[2]},
                                        frame.light_intensity[i], in.legacy_scale);
    }
    light.intensity *= level;
    if (!(luminance(light.intensity) > 0)) continue;
    if (is_headlight(in)) headlights_.push_back(lights_.size());
    light.strength = luminance(light.intensity);
    light.reach = light.kind == LightKind::kDirectional ? 0.0f : light.radius;
    lights_.push_back(light);
    power.push_back(light_power(light, scene_radius));
  }
  for (size_t i = 0; i < instances->size(); ++i) {
    InstanceView& instance = (*instances)[i];
    const InstanceDescription& described = description.instances[i];
    const int row_of_guide = is_guided(description, described) ? guide++ : -1;
    instance.light = -1;
    if (!described.shown) continue;
    const bool is_mesh =
        instance.shape == ShapeType::kMesh || instance.shape == ShapeType::kDeformable;
    const MaterialView& material = materials[instance.material];
    const float sides = is_mesh && !material.emits_outwards ? 2.0f : 1.0f;
    const float area =
        sides * (is_mesh ? meshes[instance.mesh].area : shape_area(instance.shape, instance.size));
    const float strength = luminance(material.emission) * kPi * area * material.opacity;
    if (!(strength > 0)) continue;
    instance.light = static_cast<int>(lights_.size());
    LightView light;
    light.kind = LightKind::kInstance;
    light.instance = static_cast<uint32_t>(i);
    light.guide = row_of_guide;
    light.strength = strength / (4 * kPi);
    set_bounds(instance, meshes, &light);
    lights_.push_back(light);
    power.push_back(strength);
  }
  // A share of draws goes to all lights alike: a weak lamp near a surface matters as much as a
  // strong one far away.
  constexpr float kUniformShare = 0.25f;
  double total = 0, sum = 0;
  for (const float p : power) total += p;
  for (size_t i = 0; i < lights_.size(); ++i) {
    const double p = (1 - kUniformShare) * power[i] / total +
                     kUniformShare / static_cast<double>(lights_.size());
    lights_[i].probability = static_cast<float>(p);
    lights_[i].cdf = static_cast<float>(sum += p);
  }
}

std::vector<LightView> LightTable::guided(const RenderDescription& description,
                                          const PoseFrame& frame) {
  std::vector<LightView> lights;
  for (const LightDescription& in : description.lights) {
    if (!is_guided(in)) continue;
    lights.push_back(describe_light(in));
    place(in, frame, &lights.back());
  }
  for (size_t i = 0; i < description.instances.size(); ++i) {
    if (!is_guided(description, description.instances[i])) continue;
    LightView light;
    light.kind = LightKind::kInstance;
    light.instance = static_cast<uint32_t>(i);
    lights.push_back(light);
  }
  return lights;
}

void LightTable::place_headlights(const Affine3f& X_WC) {
  for (const size_t i : headlights_) {
    lights_[i].p = X_WC.p;
    lights_[i].direction = normalize(-X_WC.z);
  }
}

}  // namespace gloam
