#pragma once
// Materials and textures of a World, without MuJoCo types. Names after OpenPBR 1.1.

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "geometry/image/image.h"
#include "world/shapes/shape_type.h"

namespace gloam {

/// Index into RenderDescription::textures, or -1.
struct MaterialTextures {
  int base_color = -1;  ///< sRGB; 4 channels carry opacity
  /// Linear; orm = occlusion, roughness, metallic in r, g, b.
  int roughness = -1, metallic = -1, occlusion = -1, orm = -1;
  int normal = -1;  ///< tangent space, linear
  int opacity = -1, emission = -1;
  int bump = -1;  ///< linear; heights of MaterialDescription::bump_scale
  int coat_weight = -1, coat_roughness = -1, transmission = -1;  ///< linear

  std::array<int, 12> all() const {
    return {base_color, roughness, metallic,    occlusion,      orm,         normal, opacity,
            emission,   bump,      coat_weight, coat_roughness, transmission};
  }
};

/// Names after OpenPBR 1.1.
struct MaterialDescription {
  std::string name;
  Vec3f base_color{0.5f, 0.5f, 0.5f};  ///< linear, multiplies the texture
  float opacity = 1;
  float metallic = 0;
  float roughness = 0.5f;         ///< roughness of the specular layer, 0..1 (alpha = roughness²)
  float specular_weight = 1;      ///< 0..1, scales the dielectric layer
  float ior = 1.5f;               ///< index of refraction of the dielectric layer
  Vec3f emission{0, 0, 0};        ///< luminance per channel [cd/m²]
  bool emits_outwards = false;    ///< the back of a mesh's triangles is dark
  int schedule = -1;              ///< row of RenderDescription::schedules, of the emission
  float anisotropy = 0;           ///< 0..1, draws highlights out along the tangent
  float anisotropy_rotation = 0;  ///< from the tangent, counter-clockwise, in turns
  float transmission_weight = 0;  ///< 0..1: glass
  /// Colour of light that has gone `transmission_depth` deep, or, where that is 0, through the
  /// surface once.
  Vec3f transmission_color{1, 1, 1};
  float transmission_depth = 0;  ///< [m]
  /// Absorption inside for LiDARs of 905 and 1550 nm [1/m]; -1 = as of red light.
  std::array<float, 2> infrared_absorption{-1, -1};
  bool thin_walled = false;     ///< a sheet: nothing is inside, nothing is bent
  float subsurface_weight = 0;  ///< 0..1
  Vec3f subsurface_color{0.8f, 0.8f, 0.8f};
  float coat_weight = 0, coat_roughness = 0, coat_ior = 1.6f;
  float coat_darkening = 1;   ///< 0..1, of the base by light that the coat reflects back down
  Vec3f coat_color{1, 1, 1};  ///< tint of light that has gone in and out through the coat
  float fuzz_weight = 0, fuzz_roughness = 0.5f;
  Vec3f fuzz_color{1, 1, 1};
  int pattern = -1, wear = -1;  ///< rows of RenderDescription::procedurals, in the geom's frame
  float wetness = 0, porosity = 0.8f, dust = 0, snow = 0;  ///< 0..1
  TextureMapping mapping = TextureMapping::kNone;
  bool texture_uniform = false;  ///< MuJoCo's texuniform: repeats per metre, not per object
  Vec2f texture_repeat{1, 1};
  MaterialTextures textures;
  float bump_scale = 0;        ///< [m] that a bump of 1 stands above one of 0
  bool glows_in_color = true;  ///< base_color's texture multiplies the emission (MuJoCo's rule)
  bool imported = false;       ///< came with a [[visual]], not with the model
  // Inputs from which set_look() (world/materials/visual_rules.h) makes the values above when they
  // change live.
  int model_material = -1;      ///< row of PoseFrame::material_rgba and its kin, -1 = none
  std::array<float, 4> rgba{};  ///< display colour and opacity as in the model
  bool own_color = false;       ///< rgba is the geom's: material_rgba does not apply
  float own_ior = 0;            ///< given by the scene instead of the rules'; 0 = not given
  bool can_mirror = false;      ///< reflectance counts: of planes and boxes
};

struct TextureDescription {
  std::string name;
  /// 1 (2-D), or 6 in the order right, left, up, down, front, back (MuJoCo's cube). Of one texture
  /// used both as colour and as data there are two rows: they differ in colour space.
  std::vector<Image8> faces;
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;  ///< 2-D alone
};

}  // namespace gloam
