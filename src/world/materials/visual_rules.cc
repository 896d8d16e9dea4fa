#include "world/materials/visual_rules.h"

#include <algorithm>
#include <cmath>

#include "base/srgb.h"

namespace gloam {

Vec3f linear_color(Vec3f srgb) {
  return {srgb_decode(srgb.x), srgb_decode(srgb.y), srgb_decode(srgb.z)};
}

Vec3f emission_luminance(Vec3f color, float emission) {
  return color * (max(emission, 0) * kWhiteLuminance);
}

float roughness_of_shininess(float shininess) {
  const float exponent = 128 * clamp(shininess, 0, 1);
  return std::sqrt(std::sqrt(2 / (exponent + 2)));
}

void set_look(const ModelSurface& surface, MaterialDescription* material) {
  const MaterialTextures& textures = material->textures;
  material->rgba = surface.rgba;
  material->base_color = linear_color({surface.rgba[0], surface.rgba[1], surface.rgba[2]});
  material->opacity = clamp(surface.rgba[3], 0, 1);
  material->specular_weight = clamp(2 * surface.specular, 0, 1);
  material->roughness = roughness_of_shininess(surface.shininess);
  material->ior = MaterialDescription().ior;
  if (material->can_mirror && surface.reflectance > 0) {
    const float f0 = clamp(surface.reflectance, 0.04f, 0.9f);
    material->ior = (1 + std::sqrt(f0)) / (1 - std::sqrt(f0));
    material->specular_weight = 1;
    material->roughness = min(material->roughness, 0.1f);
  }
  if (material->own_ior > 0) material->ior = material->own_ior;
  if (surface.roughness >= 0)
    material->roughness = clamp(surface.roughness, 0, 1);
  else if (textures.roughness >= 0 || textures.orm >= 0)
    material->roughness = 1;
  material->metallic = 0;
  if (surface.metallic >= 0)
    material->metallic = clamp(surface.metallic, 0, 1);
  else if (textures.metallic >= 0 || textures.orm >= 0)
    material->metallic = 1;
  if (textures.emission >= 0)
    material->emission = emission_luminance({1, 1, 1}, surface.emission > 0 ? surface.emission : 1);
  else
    material->emission = emission_luminance(material->base_color, surface.emission);
}

bool is_default_rgba(const float* rgba) {
  return rgba[0] == 0.5f && rgba[1] == 0.5f && rgba[2] == 0.5f && rgba[3] == 1.0f;
}

Vec3f light_intensity(Vec3f diffuse, float intensity, float legacy_scale) {
  if (intensity <= 0) return diffuse * legacy_scale;
  const float y = luminance(diffuse);
  return y > 0 ? diffuse * (intensity / y) : Vec3f{0, 0, 0};
}

float legacy_light_scale(PunctualLightType type, float distance, Vec3f attenuation) {
  const float facing_white = kPi * kWhiteLuminance;  // E = pi L of a Lambert surface of albedo 1
  if (type == PunctualLightType::kDirectional) return facing_white;
  const float dimmed = attenuation.x + attenuation.y * distance + attenuation.z * sqr(distance);
  return facing_white * sqr(distance) / (dimmed > 0 ? dimmed : 1.0f);
}

float softness_of_exponent(float exponent, float cutoff) {
  if (exponent <= 0 || cutoff <= 0) return 0;
  const float half_angle = std::acos(std::pow(0.5f, 1 / exponent));
  return clamp(2 * (1 - half_angle / cutoff), 0, 1);
}

float ev100_for(float luminance, float display) {
  return std::log2(max(luminance, 1e-6f) / (1.2f * display));
}

float mean_luminance(const TextureDescription& texture) {
  constexpr size_t kSamples = 1024;  // samples of each face, evenly spread
  double sum = 0;
  size_t count = 0;
  for (const Image8& face : texture.faces) {
    if (face.channels < 3) continue;
    const auto channels = static_cast<size_t>(face.channels);
    const size_t texels = face.texels.size() / channels;
    for (size_t i = 0; i < texels; i += texels / kSamples + 1, ++count) {
      const uint8_t* texel = face.texels.data() + i * channels;
      sum += luminance(linear_color({static_cast<float>(texel[0]) / 255.0f,
                                     static_cast<float>(texel[1]) / 255.0f,
                                     static_cast<float>(texel[2]) / 255.0f}));
    }
  }
  return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0;
}

float scene_ev100(std::span<const float> illuminance, float surround, bool photometric) {
  float sum = 0, most = 0;
  for (const float lux : illuminance) {
    sum += lux;
    most = max(most, lux);
  }
  // One surface faces one light; to the others it is turned at random: mean of max(cos, 0) = 1/4.
  float white = (most + 0.25f * (sum - most)) * kInvPi + surround;
  if (!photometric) white = max(white, kWhiteLuminance);
  return ev100_for(white, kWhiteExposed);
}

}  // namespace gloam
