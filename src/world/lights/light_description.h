#pragma once
// Lamps and sky of a World, without MuJoCo types. Radiometry: docs/light.md.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "world/sky/day_cycle.h"

namespace gloam {

/// Types of LightType without a luminous surface; lamps with one are instances of meshes and
/// spheres.
enum class PunctualLightType : uint8_t { kPoint, kSpot, kDirectional };
struct LightDescription {
  std::string name;
  PunctualLightType type = PunctualLightType::kPoint;
  bool active = true;
  bool casts_shadow = true;
  /// Point, spot: [cd] per channel; directional: illuminance on a facing surface [lx].
  Vec3f intensity{0, 0, 0};
  /// Radius of the luminous sphere (point, spot) [m]; directional: sine of the half angle.
  float radius = 0;
  float cos_cutoff = -1;  ///< spot: cosine of the half angle of the cone
  float softness = 0;     ///< spot: fraction of the cone over which it fades
  /// Factor on PoseFrame::light_diffuse that gives `intensity` while the light has no intensity in
  /// cd (docs/light.md)
  float legacy_scale = 0;
  Vec3f ambient{0, 0, 0};  ///< MuJoCo's; a part of SkyDescription::ambient while it is active, the
                           ///< headlight's always
  bool is_static = false;  ///< never moves: fixed to a body that is welded to the world
  int profile = -1;        ///< row of ies_profiles: `intensity` is where the profile is at its most
  int schedule = -1;       ///< row of schedules, a factor on `intensity`
  // Place: row of PoseFrame's light poses; or fixed to a body, shining along its own -Z; or, with
  // neither, the headlight: at the camera, along its axis.
  int light = -1;
  int body = -1;
  Affine3f X_BL;
  int motion = -1;      ///< row of motions, of X_BL
  bool of_sky = false;  ///< the sun of the scene's sky; of SkyDescription::day it is as at time 0
};

/// Light from far away, laid out as SkyLight::texels (world/sky/atmosphere.h).
struct EnvironmentDescription {
  std::string name;
  int width = 0, height = 0;  ///< [texels]; 0 = none
  std::vector<Vec3f> texels;  ///< (height x width), linear Rec. 709, finite, >= 0
  float scale = 1;            ///< [cd/m²] of a texel of one
  float turn = 0;             ///< about the world's Z, counter-clockwise from above [rad]
};

/// Radiance of rays that leave the scene.
struct SkyDescription {
  int texture = -1;        ///< cube texture (MuJoCo's skybox), luminance = sRGB value * scale
  float scale = 0;         ///< [cd/m²] of a white texel
  Vec3f ambient{0, 0, 0};  ///< constant luminance per channel [cd/m²], added for indirect rays only
                           ///< (MuJoCo's ambient lights)
  int schedule = -1;       ///< row of RenderDescription::schedules, of `ambient`
  EnvironmentDescription environment;  ///< instead of the texture; of `day` at time 0
  std::optional<DayCycle> day;
};

}  // namespace gloam
