#pragma once
// The rules that turn MuJoCo's display-referred colours and lights into photometry: docs/light.md
// explains each. Free of MuJoCo types, because live fields pass through the same rules.

#include <array>
#include <span>

#include "base/vec.h"
#include "world/render_description.h"

namespace gloam {

/// Luminance of what MuJoCo calls full white: white under a light of diffuse 1, a white texel of
/// the sky, a white material of emission 1 [cd/m²].
inline constexpr float kWhiteLuminance = 100;

/// Place of kWhiteLuminance on the display scale 0..1 before tone mapping.
inline constexpr float kWhiteExposed = 0.85f;

/// MuJoCo's colours are display values: sRGB (IEC 61966-2-1) to linear Rec. 709.
Vec3f linear_color(Vec3f srgb);

/// Luminance per channel [cd/m²] of a material of linear colour `color` and MuJoCo's emission >= 0.
Vec3f emission_luminance(Vec3f color, float emission);

/// GGX roughness (alpha = roughness²) of a Blinn-Phong lobe with exponent 128 x shininess.
float roughness_of_shininess(float shininess);

/// Surface in MuJoCo's terms; these are its defaults.
struct ModelSurface {
  std::array<float, 4> rgba{0.5f, 0.5f, 0.5f, 1};  ///< display colour and opacity
  float emission = 0, specular = 0.5f, shininess = 0.5f, reflectance = 0;
  float metallic = -1, roughness = -1;  ///< -1 = not given
};

/// Writes what `surface` looks like into `material`, whose textures and can_mirror are set. A value
/// multiplies its texture; a texture without a value stands alone.
void set_look(const ModelSurface& surface, MaterialDescription* material);

/// Geoms, skins, flexes and tendons without a colour of their own have this one.
bool is_default_rgba(const float* rgba);

/// Value of LightDescription::intensity, from the light's live values. `intensity` [cd], 0 = none
/// given: then `legacy_scale` x diffuse. Otherwise diffuse gives the hue only. Directional: [lx].
Vec3f light_intensity(Vec3f diffuse, float intensity, float legacy_scale);

/// Scale of a legacy light that lights a facing white surface to diffuse x kWhiteLuminance at the
/// distance `distance` [m] (directional: anywhere); `attenuation` = constant, linear, quadratic.
float legacy_light_scale(PunctualLightType type, float distance, Vec3f attenuation);

/// Share of the cone over which a spot of OpenGL exponent `exponent` fades: its intensity is half
/// at the angle where cos^exponent is. `cutoff` = half angle [rad].
float softness_of_exponent(float exponent, float cutoff);

/// EV100 at which a luminance lands on `display` of the scale 0..1: L_max = 1.2 x 2^EV (ISO 2720
/// with a saturation-based sensitivity).
float ev100_for(float luminance, float display);

/// Mean luminance of an sRGB texture over all its faces, 0..1, from a sample of its texels.
float mean_luminance(const TextureDescription& texture);

/// EV100 of a scene: `illuminance` [lx] of each active light on a surface that faces it at the
/// model's centre, `surround` = luminance of sky and ambient light [cd/m²], `photometric` = at
/// least one active light has an intensity in cd.
float scene_ev100(std::span<const float> illuminance, float surround, bool photometric);

}  // namespace gloam
