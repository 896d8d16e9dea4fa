#pragma once
// Materials as model files describe them, in the terms of OpenPBR 1.1 (Academy Software Foundation)
// whatever the format.

#include <cmath>
#include <cstdint>
#include <string>

#include "base/vec.h"
#include "geometry/image/image.h"

namespace gloam {

enum class AlphaMode : uint8_t {
  kOpaque,  ///< opacity counts as 1
  kMask,    ///< there where opacity >= alpha_cutoff, absent elsewhere
  kBlend,   ///< opacity is the fraction of the surface that is there
};

/// Texture coordinates changed before the look-up, as in KHR_texture_transform: they act on
/// (u, 1 - v) of the mesh, that is with v growing downwards: scale, then rotation, then offset.
struct UvTransform {
  Vec2f offset = {0, 0};
  float rotation = 0;  ///< [rad]
  Vec2f scale = {1, 1};
};

/// uv of a mesh (v upwards) -> uv in the picture (v upwards, 0 = its lower edge).
inline Vec2f transform_uv(const UvTransform& t, Vec2f uv) {
  const float c = std::cos(t.rotation), s = std::sin(t.rotation);
  const float u = uv.x * t.scale.x, v = (1 - uv.y) * t.scale.y;
  return {c * u + s * v + t.offset.x, 1 - (-s * u + c * v + t.offset.y)};
}

/// Channels of a picture that a texture reads.
enum class TextureChannel : uint8_t { kRed, kGreen, kBlue, kAlpha, kColor };

/// A picture put on a material. Its value multiplies the material's own number or colour, unless
/// the material says otherwise.
struct TextureRef {
  int image = -1;  ///< index in ModelFile::images; -1 = none
  TextureChannel channel = TextureChannel::kColor;
  ColorSpace color_space = ColorSpace::kLinear;
  int uv_set = 0;  ///< 0 or 1: TriangleMesh::uvs or uvs1
  UvTransform transform = {};
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
  bool nearest = false;  ///< texels are not blended when magnified
  bool ok() const { return image >= 0; }
  bool operator==(const TextureRef& o) const {
    return image == o.image && channel == o.channel && color_space == o.color_space &&
           uv_set == o.uv_set && transform.offset.x == o.transform.offset.x &&
           transform.offset.y == o.transform.offset.y &&
           transform.rotation == o.transform.rotation && transform.scale.x == o.transform.scale.x &&
           transform.scale.y == o.transform.scale.y && wrap_u == o.wrap_u && wrap_v == o.wrap_v &&
           nearest == o.nearest;
  }
};

/// Colours are linear Rec. 709, weights and fractions 0..1.
struct MaterialValues {
  Vec3f base_color = {1, 1, 1};
  TextureRef base_color_texture;
  float metallic = 0;
  TextureRef metallic_texture;
  float roughness = 1;  ///< perceptual: the microfacets' alpha is its square
  TextureRef roughness_texture;

  float ior = 1.5f;  ///< 0 or >= 1; 0 = reflects like a mirror (KHR_materials_ior)
  float specular_weight = 1;
  TextureRef specular_weight_texture;
  Vec3f specular_color = {1, 1, 1};
  TextureRef specular_color_texture;

  float transmission_weight = 0;
  TextureRef transmission_texture;
  Vec3f transmission_color = {1, 1, 1};  ///< colour of white light after transmission_depth
  float transmission_depth = 0;          ///< [m] in the mesh's frame; 0 = nothing is absorbed
  bool thin_walled = false;              ///< a sheet: light passes without being bent

  float coat_weight = 0;
  TextureRef coat_weight_texture;
  float coat_roughness = 0;
  TextureRef coat_roughness_texture;
  TextureRef coat_normal_texture;
  float coat_normal_scale = 1;

  float fuzz_weight = 0;
  Vec3f fuzz_color = {1, 1, 1};
  TextureRef fuzz_color_texture;
  float fuzz_roughness = 0.5f;
  TextureRef fuzz_roughness_texture;

  float anisotropy = 0;
  float anisotropy_rotation = 0;  ///< [rad], counter-clockwise from the direction of u
  /// As in KHR_materials_anisotropy: red, green = direction in [-1, 1], blue = strength.
  TextureRef anisotropy_texture;

  Vec3f emission = {0, 0, 0};  ///< luminance of each primary [cd/m²]
  TextureRef emission_texture;

  float opacity = 1;
  TextureRef opacity_texture;
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;

  TextureRef normal_texture;  ///< tangent space, x along u, y along v upwards
  float normal_scale = 1;     ///< scale of its x and y
  TextureRef bump_texture;    ///< height
  float bump_scale = 1;       ///< [m] that a texel of 1 stands above one of 0
  TextureRef occlusion_texture;
  float occlusion_strength = 1;

  bool double_sided = false;
  bool unlit = false;  ///< base_color is shown as it is (KHR_materials_unlit)
};

struct ImportedMaterial : MaterialValues {
  std::string name;
};

}  // namespace gloam
