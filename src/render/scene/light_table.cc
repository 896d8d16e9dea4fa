#include "render/scene/light_table.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "render/kernel/light/light_sampler.h"
#include "render/kernel/surface/shapes.h"
#include "render/scene/pose.h"
#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

bool is_headlight(const LightDescription& light) { return light.light < 0 && light.body < 0; }

LightView describe_light(const LightDescription& in) {
  LightView out;
  out.kind = in.type == PunctualLightType::kPoint  ? LightKind::kPoint
             : in.type == PunctualLightType::kSpot ? LightKind::kSpot
                                                   : LightKind::kDirectional;
  out.casts_shadow = in.casts_shadow;
  out.intensity = in.intensity;
  out.radius = max(in.radius, 0.0f);
  out.profile = in.profile;
  out.is_delta = out.radius <= 0;
  if (out.kind == LightKind::kDirectional) out.spread = std::asin(min(out.radius, 1.0f));
  if (out.kind == LightKind::kSpot) {
    out.cos_cutoff = clamp(in.cos_cutoff, -1.0f, 1.0f);
    out.cutoff = std::acos(out.cos_cutoff);
    out.inner = out.cutoff * (1.0f - clamp(in.softness, 0.0f, 1.0f));
    out.cos_inner = std::cos(out.inner);
    out.spread = out.inner;
    out.falloff = out.cutoff - out.inner;
  }
  return out;
}

/// The cone of the normals of a mesh that shines on their side alone. Nothing if it is as wide as
/// half of all directions: then hardly a place is dark, and closed meshes are known at once.
void set_cone(const InstanceView& instance, const MeshView& mesh, LightView* light) {
  const auto corners = [&](uint32_t i) {  // twice its area along its normal, in G
    const Vec3f a = mesh.positions[mesh.indices[i]];
    return cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a);
  };
  Vec3f sum;
  for (uint32_t i = 0; i + 2 < mesh.indices.size; i += 3) sum += corners(i);
  if (!(length(sum) > 0)) return;
  const Vec3f axis = normalize(sum);
  float spread = 0;
  for (uint32_t i = 0; i + 2 < mesh.indices.size; i += 3) {
    const Vec3f normal = corners(i);
    const float cosine = dot(normal, axis), sine = length(cross(normal, axis));
    if (!(cosine > 0 || sine > 0)) continue;  // of no area
    spread = max(spread, std::atan2(sine, cosine));
    if (spread >= 0.5f * kPi) return;
  }
  light->direction = normalize(transform_vector(instance.X_WG, axis));
  light->spread = spread;
  light->falloff = 0.5f * kPi;
}

/// A sphere and a box that hold the emitter during the shutter, and the cone in which it shines.
void set_bounds(const InstanceView& instance, bool is_one_sided,
                const std::vector<MeshView>& meshes, LightView* light) {
  Vec3f low{1e30f, 1e30f, 1e30f}, high = -low;
  const auto add = [&](Vec3f p) {
    low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
    high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
  };
  const auto add_G = [&](Vec3f p_G) {
    add(transform_point(instance.X_WG, p_G));
    for (uint32_t k = 0; k < instance.keys.size; ++k) add(transform_point(instance.keys[k], p_G));
  };
  const Vec3f h = shape_half_size(instance.shape, instance.size);
  const float tip = instance.shape == ShapeType::kCapsule ? instance.size.x : 0.0f;
  if (instance.shape == ShapeType::kDeformable) {
    const MeshView& mesh = meshes[instance.mesh];
    for (uint32_t i = 0; i < mesh.positions.size; ++i) add(mesh.positions[i]);
    for (uint32_t i = 0; i < mesh.position_keys.size; ++i) add(mesh.position_keys[i]);
  } else if (instance.shape == ShapeType::kMesh) {
    const MeshView& mesh = meshes[instance.mesh];
    for (uint32_t i = 0; i < mesh.positions.size; ++i) add_G(mesh.positions[i]);
  } else if (instance.shape == ShapeType::kSphere) {
    const auto add_ball = [&](Vec3f p) {
      add(p - h);
      add(p + h);
    };
    add_ball(instance.X_WG.p);
    for (uint32_t k = 0; k < instance.keys.size; ++k) add_ball(instance.keys[k].p);
  } else {
    for (int i = 0; i < 8; ++i) {
      add_G({(i & 1) != 0 ? h.x : -h.x, (i & 2) != 0 ? h.y : -h.y,
             (i & 4) != 0 ? h.z + tip : -h.z - tip});
    }
  }
  if (low.x > high.x) return;  // a mesh without vertices
  light->p = (low + high) * 0.5f;
  light->half = (high - low) * 0.5f;
  light->reach = length(light->half);
  if (!is_mesh(instance.shape) && !instance.moving)
    light->reach = min(light->reach, length(h) + tip);
  if (instance.shape == ShapeType::kPlane && !instance.moving) {  // its back is dark
    light->direction = normalize(instance.X_WG.z);
    light->spread = 0;
    light->falloff = 0.5f * kPi;
  }
  if (instance.shape == ShapeType::kMesh && is_one_sided && !instance.moving)
    set_cone(instance, meshes[instance.mesh], light);
}

/// Whether the mesh is a parallelogram of two triangles, a c b and a d c, as lamps are; then sets
/// the light's edges.
bool set_sheet(const InstanceView& instance, const MeshView& mesh, LightView* light) {
  if (mesh.indices.size != 6) return false;
  const DeviceSpan<const uint32_t>& i = mesh.indices;
  if (i[3] != i[0] || i[5] != i[1]) return false;
  const Vec3f a = mesh.positions[i[0]], c = mesh.positions[i[1]];
  const Vec3f to_b = mesh.positions[i[2]] - a, to_d = mesh.positions[i[4]] - a;
  if (!(length(to_b + to_d - (c - a)) <= 1e-6f * length(c - a))) return false;
  if (!(length(cross(to_d, to_b)) > 0)) return false;
  light->p = transform_point(instance.X_WG, (a + c) * 0.5f);
  light->edges[0] = transform_vector(instance.X_WG, to_d);
  light->edges[1] = transform_vector(instance.X_WG, to_b);
  return true;
}

bool is_finite(const LightView& light) {
  constexpr float kMost = 1e18f;  // squares and their sums stay finite
  const float far = fabsf(light.p.x) + fabsf(light.p.y) + fabsf(light.p.z);
  return light.strength < kMost && far < kMost && light.reach < kMost;
}

/// Instance `row` as a light; nothing where it gives off none.
std::optional<LightView> emitter_of(const std::vector<InstanceView>& instances, size_t row,
                                    const std::vector<MaterialView>& materials,
                                    const std::vector<MeshView>& meshes) {
  const InstanceView& instance = instances[row];
  const bool is_mesh =
      instance.shape == ShapeType::kMesh || instance.shape == ShapeType::kDeformable;
  const MaterialView& material = materials[instance.material];
  const float sides = is_mesh && !material.emits_outwards ? 2.0f : 1.0f;
  const float area =
      sides * (is_mesh ? meshes[instance.mesh].area : shape_area(instance.shape, instance.size));
  const float strength = luminance(material.emission) * kPi * area * material.opacity;
  if (!(strength > 0)) return {};
  LightView light;
  light.kind = LightKind::kInstance;
  light.instance = static_cast<uint32_t>(row);
  light.strength = strength / (4 * kPi);
  light.levels = material.levels;
  set_bounds(instance, material.emits_outwards, meshes, &light);
  if (!is_finite(light)) return {};
  if (instance.moving || material.textured) return light;
  light.intensity = material.emission * material.opacity;
  if (instance.shape == ShapeType::kSphere && light.levels < 0) {
    light.is_ball = true;
    light.p = instance.X_WG.p;
    light.radius = instance.size.x;
  }
  light.is_sheet = instance.shape == ShapeType::kMesh && material.emits_outwards &&
                   set_sheet(instance, meshes[instance.mesh], &light);
  return light;
}

void set_strength(LightView* light) {
  light->strength = luminance(light->intensity);
  light->reach = light->kind == LightKind::kDirectional ? 0.0f : light->radius;
  light->half = Vec3f{1, 1, 1} * light->reach;
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
void place(const RenderDescription& description, const LightDescription& in, const PoseFrame& frame,
           LightView* light) {
  if (in.light >= 0) {
    light->p = row(frame.light_p, in.light);
    light->direction = normalize(row(frame.light_dir, in.light));
    light->x = Frame::from_z(-light->direction).x;
  } else if (in.body >= 0) {
    const Affine3f X_WL = pose_in_world(description, frame, in);
    light->p = X_WL.p;
    light->direction = -normalize(X_WL.z);
    light->x = normalize(X_WL.x);
  }
}

}  // namespace

/// A light that moves: bounds of its way, for its selection.
void LightTable::set_keys(std::span<const LightKey> keys, LightView* light) {
  light->first_key = static_cast<int>(keys_.size());
  key_count_ = static_cast<uint32_t>(keys.size());
  keys_.insert(keys_.end(), keys.begin(), keys.end());
  light->spread = kPi;
  if (light->kind == LightKind::kDirectional) return;
  Vec3f low = keys[0].p, high = low;
  for (const LightKey& key : keys) {
    low = {min(low.x, key.p.x), min(low.y, key.p.y), min(low.z, key.p.z)};
    high = {max(high.x, key.p.x), max(high.y, key.p.y), max(high.z, key.p.z)};
  }
  light->p = (low + high) * 0.5f;
  light->half = (high - low) * 0.5f + Vec3f{1, 1, 1} * light->radius;
  light->reach = length((high - low) * 0.5f) + light->radius;
}

void LightTable::update(const RenderDescription& description,
                        std::span<const PoseFrame* const> keys,
                        const std::vector<LightLevel>& levels, const MovingSun* sun,
                        const std::vector<MaterialView>& materials,
                        const std::vector<MeshView>& meshes, std::vector<InstanceView>* instances) {
  const PoseFrame& frame = *keys.front();
  const bool live = frame.live_serial != 0;
  keys_.clear();
  const std::vector<LightView> before = std::exchange(lights_, {});
  const std::vector<uint32_t> headlights_before = std::exchange(headlights_, {});
  lights_.reserve(before.size());
  int guide = 0;
  size_t row_of_light = 0;
  for (const LightDescription& in : description.lights) {
    const int row_of_guide = is_guided(in) ? guide++ : -1;
    const LightLevel& level = levels[row_of_light++];
    const bool follows = live && in.light >= 0;
    const size_t i = follows ? static_cast<size_t>(in.light) : 0;
    if (follows ? frame.light_active[i] == 0 : !in.active) continue;
    LightView light = describe_light(in);
    light.guide = row_of_guide;
    place(description, in, frame, &light);
    if (follows) {
      const float* diffuse = &frame.light_diffuse[3 * i];
      light.intensity = light_intensity({diffuse[0], diffuse[1], diffuse[2]},
                                        frame.light_intensity[i], in.legacy_scale);
    }
    const bool is_moving_sun = in.of_sky && sun != nullptr;
    if (is_moving_sun) {  // hardly while the shutter is open: it has no keys
      light.direction = -sun->to_sun;
      light.x = Frame::from_z(sun->to_sun).x;
      light.intensity = sun->illuminance;
    }
    light.intensity *= level.mean;
    light.levels = level.row;
    if (!(luminance(light.intensity) > 0)) continue;
    set_strength(&light);
    if (keys.size() > 1 && !in.is_static && !is_moving_sun && !is_headlight(in)) {
      std::vector<LightKey> way;
      LightView at = light;
      bool moving = false;
      for (const PoseFrame* key : keys) {
        place(description, in, *key, &at);
        way.push_back({at.p, at.direction, at.x});
        moving |= !(at.p == light.p && at.direction == light.direction && at.x == light.x);
      }
      if (moving) set_keys(way, &light);
    }
    if (!is_finite(light)) continue;
    if (is_headlight(in)) headlights_.push_back(static_cast<uint32_t>(lights_.size()));
    lights_.push_back(light);
  }
  for (size_t i = 0; i < instances->size(); ++i) {
    InstanceView& instance = (*instances)[i];
    const InstanceDescription& described = description.instances[i];
    const int row_of_guide = is_guided(description, described) ? guide++ : -1;
    instance.light = -1;
    if (!described.shown) continue;
    std::optional<LightView> light = emitter_of(*instances, i, materials, meshes);
    if (!light) continue;
    light->guide = row_of_guide;
    instance.light = static_cast<int>(lights_.size());
    lights_.push_back(*light);
  }
  lamp_keys_ = keys_.size();
  update_tree(before, headlights_before);
}

void LightTable::update_tree(const std::vector<LightView>& before,
                             const std::vector<uint32_t>& headlights_before) {
  if (headlights_ == headlights_before) {  // which stay at the last camera until the next
    for (const uint32_t i : headlights_) {
      if (i >= before.size()) break;
      lights_[i].p = before[i].p;
      lights_[i].direction = before[i].direction;
    }
  }
  if (lights_ == before) return;
  has_visible_ = std::any_of(lights_.begin(), lights_.end(), [](const LightView& light) {
    return !light.is_delta && light.casts_shadow && light.kind != LightKind::kInstance;
  });
  if (lights_.size() > kMaxLightsWithoutTree) {
    tree_.build(lights_, headlights_);
  } else {
    tree_ = {};
  }
}

std::vector<LightView> LightTable::guided(const RenderDescription& description,
                                          const PoseFrame& frame,
                                          const std::vector<MaterialView>& materials,
                                          const std::vector<MeshView>& meshes,
                                          std::vector<InstanceView>* instances) {
  std::vector<LightView> lights;
  for (const LightDescription& in : description.lights) {
    if (!is_guided(in)) continue;
    lights.push_back(describe_light(in));
    place(description, in, frame, &lights.back());
    set_strength(&lights.back());
  }
  for (size_t i = 0; i < instances->size(); ++i) {
    InstanceView& instance = (*instances)[i];
    instance.material = static_cast<uint32_t>(description.instances[i].material);
    instance.light = -1;
    if (!is_guided(description, description.instances[i])) continue;
    instance.light = static_cast<int>(lights.size());
    lights.push_back(emitter_of(*instances, i, materials, meshes).value_or(LightView{}));
  }
  return lights;
}

void LightTable::place_headlights(const Affine3f& X_WC, std::span<const Affine3f> keys) {
  keys_.resize(lamp_keys_);
  for (const uint32_t i : headlights_) {
    LightView& light = lights_[i];
    light.p = X_WC.p;
    light.direction = normalize(-X_WC.z);
    light.first_key = -1;
    if (keys.empty()) continue;
    std::vector<LightKey> way;
    for (const Affine3f& X : keys) way.push_back({X.p, normalize(-X.z), light.x});
    set_keys(way, &light);
  }
  if (lights_.size() > kMaxWeighedLights) tree_.move_headlights(lights_, headlights_);
}

}  // namespace gloam
