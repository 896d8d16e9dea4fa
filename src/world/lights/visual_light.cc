#include "world/lights/visual_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "world/lights/ktx_light.h"
#include "world/materials/visual_rules.h"
#include "world/sky/environment.h"

namespace gloam {
namespace {

Vec3f vec3(const float* v) { return {v[0], v[1], v[2]}; }
Vec3f vec3(const mjtNum* v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

LightDescription model_light(const mjModel& m, int i, float distance) {
  LightDescription light;
  if (const char* name = mj_id2name(&m, mjOBJ_LIGHT, i)) light.name = name;
  light.light = i;
  light.active = m.light_active[i] != 0;
  light.casts_shadow = m.light_castshadow[i] != 0;
  light.radius = max(m.light_bulbradius[i], 0);
  const float cutoff = clamp(m.light_cutoff[i] * (kPi / 180), 0, kPi);
  switch (m.light_type[i]) {
    case mjLIGHT_DIRECTIONAL:
      light.type = PunctualLightType::kDirectional;
      light.radius = min(light.radius, 1);
      break;
    case mjLIGHT_POINT:
      light.type = PunctualLightType::kPoint;
      break;
    default:
      // OpenGL's cutoff of 180 degrees is a light that shines everywhere.
      light.type = cutoff >= kPi ? PunctualLightType::kPoint : PunctualLightType::kSpot;
      light.cos_cutoff = std::cos(cutoff);
      light.softness = clamp(m.light_softness[i], 0, 1);
  }
  light.ambient = vec3(m.light_ambient + 3 * i);
  light.legacy_scale = legacy_light_scale(light.type, distance, vec3(m.light_attenuation + 3 * i));
  const float candela = m.light_intensity[i];
  if (candela <= 0 && light.type == PunctualLightType::kSpot)
    light.softness = max(light.softness, softness_of_exponent(m.light_exponent[i], cutoff));
  light.intensity = light_intensity(vec3(m.light_diffuse + 3 * i), candela, light.legacy_scale);
  return light;
}

/// A cube texture or the cube of a KTX file; the light's intensity is the luminance of a white
/// texel, if it has one.
void set_image_light(const mjModel& m, int i, MaterialTable* materials, RenderDescription* out) {
  const int texid = m.light_texid[i];
  const float scale = m.light_intensity[i] > 0 ? m.light_intensity[i] : kWhiteLuminance;
  const char* name = texid >= 0 ? mj_id2name(&m, mjOBJ_TEXTURE, texid) : nullptr;
  SkyDescription& sky = out->sky;
  if (texid >= 0 && m.tex_type[texid] != mjTEXTURE_2D) {
    sky.texture = materials->texture_row(texid, ColorSpace::kSrgb);
    sky.scale = scale;
    return;
  }
  const KtxImage ktx = texid >= 0 ? embedded_ktx(m, texid) : KtxImage();
  if (ktx.float_faces.size() == 6) {
    sky.environment = environment_of(ktx, name != nullptr ? name : "");
    sky.environment.scale = scale;
  } else if (ktx.faces.size() == 6) {
    sky.texture = static_cast<int>(out->textures.size());
    sky.scale = scale;
    out->textures.push_back({name != nullptr ? name : "", ktx.faces});
  } else {
    out->unsupported.push_back({ErrorKind::kUnsupported,
                                fmt::format("image light {} has no cube texture; it is dark", i)});
  }
}

}  // namespace

void LightLevels::add(const LightDescription& light, float distance) {
  const float lux = luminance(light.intensity);
  photometric = photometric || lux > 0;
  illuminance.push_back(light.type == PunctualLightType::kDirectional ? lux : lux / sqr(distance));
}

float light_distance(Vec3f p_W, const RenderDescription& scene) {
  constexpr float kNearestShare = 0.25f;
  return max(length(p_W - scene.center), kNearestShare * max(scene.extent, 1e-3f));
}

LightLevels describe_light(const mjModel& model, const Scene& scene,
                           const std::vector<Affine3f>& poses, LightLevels levels,
                           MaterialTable* materials, RenderDescription* out) {
  const bool own_sky = scene.sky.has_value();
  levels.photometric = levels.photometric || own_sky || !scene.lights.empty();

  for (int i = 0; i < static_cast<int>(model.ntex) && out->sky.texture < 0 && !own_sky; ++i)
    if (model.tex_type[i] == mjTEXTURE_SKYBOX) {
      out->sky.texture = materials->texture_row(i, ColorSpace::kSrgb);
      out->sky.scale = kWhiteLuminance;
    }

  Vec3f ambient{};
  for (int i = 0; i < static_cast<int>(model.nlight); ++i) {
    if (model.light_type[i] == mjLIGHT_IMAGE) {
      if (model.light_active[i] != 0 && !own_sky) set_image_light(model, i, materials, out);
      continue;
    }
    const Vec3f p_W =
        poses[static_cast<size_t>(model.light_bodyid[i])].p + vec3(model.light_pos0 + 3 * i);
    const float distance = light_distance(p_W, *out);
    out->lights.push_back(model_light(model, i, distance));
    LightDescription& light = out->lights.back();
    if (own_sky) light.ambient = {};
    if (!light.active) continue;
    ambient += light.ambient;
    levels.photometric = levels.photometric || model.light_intensity[i] > 0;
    const float lux = luminance(light.intensity);
    levels.illuminance.push_back(
        light.type == PunctualLightType::kDirectional ? lux : lux / sqr(distance));
  }
  if (own_sky) return levels;

  const auto& headlight = model.vis.headlight;
  constexpr int kAuto = 2;
  LightDescription head;
  head.name = "headlight";
  head.type = PunctualLightType::kDirectional;
  head.casts_shadow = false;
  // MuJoCo's own renderer leaves an automatic headlight on, and models without intensities are
  // lit to suit it.
  head.active = headlight.active == kAuto ? !levels.photometric : headlight.active != 0;
  head.legacy_scale = legacy_light_scale(PunctualLightType::kDirectional, 0, {1, 0, 0});
  head.intensity = light_intensity(vec3(headlight.diffuse), 0, head.legacy_scale);
  if (headlight.active != 0) head.ambient = vec3(headlight.ambient);
  ambient += head.ambient;
  if (head.active) levels.illuminance.push_back(luminance(head.intensity));
  out->lights.push_back(head);

  out->sky.ambient = ambient * kWhiteLuminance;
  return levels;
}

float exposure(const LightLevels& levels, const RenderDescription& scene) {
  float surround = luminance(scene.sky.ambient);
  if (scene.sky.texture >= 0)
    surround +=
        scene.sky.scale * mean_luminance(scene.textures[static_cast<size_t>(scene.sky.texture)]);
  if (scene.sky.environment.width > 0) surround += brightest_side(scene.sky.environment) * kInvPi;
  return scene_ev100(levels.illuminance, surround, levels.photometric);
}

}  // namespace gloam
