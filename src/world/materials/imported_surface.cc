#include "world/materials/imported_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

/// Height of a bump of MTL, as a fraction of the texture's length, with -bm 1.
constexpr float kBumpShare = 0.01f;
constexpr float kCoatIor = 1.5f;  // KHR_materials_clearcoat
constexpr float kMirrorIor = 1000;

bool same_transform(const UvTransform& a, const UvTransform& b) {
  return a.offset.x == b.offset.x && a.offset.y == b.offset.y && a.rotation == b.rotation &&
         a.scale.x == b.scale.x && a.scale.y == b.scale.y;
}

class SurfaceMaker {
 public:
  SurfaceMaker(const ImportedMaterial& in, const std::string& name, float scale,
               ImportedTextures* textures, RenderDescription* out)
      : in_(in), scale_(scale), textures_(textures), out_(out) {
    surface_.material.name = name;
    surface_.material.imported = true;
    surface_.material.glows_in_color = false;
  }

  ImportedSurface make() {
    choose_uvs();
    set_base();
    set_opacity();
    set_specular();
    set_layers();
    set_transmission();
    set_emission();
    set_relief();
    return std::move(surface_);
  }

 private:
  MaterialDescription& m() { return surface_.material; }

  void leave_out(const std::string& what, const char* hint = "") {
    out_->unsupported.push_back(
        {ErrorKind::kUnsupported, fmt::format("material '{}': {}", m().name, what), {}, hint});
  }

  /// A material's textures share one set of coordinates: those of the first of these.
  void choose_uvs() {
    const TextureRef* shown[] = {&in_.base_color_texture,     &in_.roughness_texture,
                                 &in_.metallic_texture,       &in_.normal_texture,
                                 &in_.emission_texture,       &in_.opacity_texture,
                                 &in_.bump_texture,           &in_.coat_weight_texture,
                                 &in_.coat_roughness_texture, &in_.transmission_texture};
    bool all_repeat = true;
    for (const TextureRef* texture : shown) {
      if (!textures_->has(*texture)) continue;
      if (reference_ == nullptr) reference_ = texture;
      all_repeat = all_repeat && texture->wrap_u == TextureWrap::kRepeat &&
                   texture->wrap_v == TextureWrap::kRepeat;
      if (texture->nearest && !told_nearest_) {
        leave_out("its texels are interpolated: nearest-neighbour sampling is ignored");
        told_nearest_ = true;
      }
    }
    if (reference_ == nullptr) return;
    m().mapping = TextureMapping::kUv;
    surface_.uv = {reference_->uv_set, reference_->transform};
    UvTransform& t = surface_.uv.transform;
    if (all_repeat)
      t.offset = {t.offset.x - std::floor(t.offset.x), t.offset.y - std::floor(t.offset.y)};
    // A pure scaling goes to the material, so that the mesh stays as it is for others.
    if (t.offset.x == 0 && t.offset.y == 0 && t.rotation == 0 && t.scale.x > 0 && t.scale.y > 0) {
      m().texture_repeat = t.scale;
      t.scale = {1, 1};
    }
  }

  bool usable(const TextureRef& texture, const char* what) {
    if (!textures_->has(texture)) return false;
    if (texture.uv_set == reference_->uv_set &&
        same_transform(texture.transform, reference_->transform))
      return true;
    leave_out(fmt::format(
        "its {} texture has other coordinates than its first texture and is ignored", what));
    return false;
  }
  int row_of(const TextureRef& texture, const char* what) {
    return usable(texture, what) ? textures_->row({texture}) : -1;
  }
  /// Mean of a texture that the renderer has no place for.
  float mean_of(const TextureRef& texture, const char* what) {
    if (!textures_->has(texture)) return 1;
    leave_out(fmt::format("only the mean of its {} texture is used", what));
    return textures_->mean(texture).x;
  }
  Vec3f mean_color_of(const TextureRef& texture, const char* what) {
    if (!textures_->has(texture)) return {1, 1, 1};
    leave_out(fmt::format("only the mean of its {} texture is used", what));
    return textures_->mean(texture);
  }

  void set_base() {
    m().base_color = in_.base_color;
    m().metallic = in_.metallic;
    m().roughness = in_.roughness;
    MaterialTextures& map = m().textures;
    const TextureRef &rough = in_.roughness_texture, &metal = in_.metallic_texture;
    TextureRef both = rough;
    both.channel = metal.channel;
    if (rough.channel == TextureChannel::kGreen && metal.channel == TextureChannel::kBlue &&
        both == metal) {
      both.channel = TextureChannel::kColor;
      map.orm = row_of(both, "metallic and roughness");
    } else {
      map.roughness = row_of(rough, "roughness");
      map.metallic = row_of(metal, "metallic");
    }
  }

  void set_opacity() {
    MaterialTextures& map = m().textures;
    const bool opaque = in_.alpha_mode == AlphaMode::kOpaque;
    const bool mask = in_.alpha_mode == AlphaMode::kMask;
    const bool has_color = usable(in_.base_color_texture, "base colour");
    const bool has_opacity = !opaque && usable(in_.opacity_texture, "opacity");
    TextureRecipe color{in_.base_color_texture}, opacity{in_.opacity_texture};
    m().opacity = opaque ? 1 : in_.opacity;
    if (mask) {
      const float cutoff = in_.opacity > 0 ? in_.alpha_cutoff / in_.opacity : 2;
      if (has_opacity) color.cutoff = opacity.cutoff = cutoff;
      m().opacity = has_opacity || in_.opacity >= in_.alpha_cutoff ? 1 : 0;
    }
    TextureRef alpha_of_color = in_.base_color_texture;
    alpha_of_color.channel = TextureChannel::kAlpha;
    alpha_of_color.color_space = in_.opacity_texture.color_space;
    color.keep_alpha = has_color && has_opacity && alpha_of_color == in_.opacity_texture;
    if (!color.keep_alpha) color.cutoff = -1;
    if (has_color) map.base_color = textures_->row(color);
    if (has_opacity && !color.keep_alpha) map.opacity = textures_->row(opacity);
  }

  void set_specular() {
    m().specular_weight =
        in_.specular_weight * mean_of(in_.specular_weight_texture, "specular weight");
    const float ior = in_.ior == 0 ? kMirrorIor : in_.ior;
    m().ior = ior;
    const Vec3f color =
        in_.specular_color * mean_color_of(in_.specular_color_texture, "specular colour");
    if (color == Vec3f{1, 1, 1}) return;
    if (color.x != color.y || color.y != color.z)
      leave_out("only the brightness of its specular colour is used");
    if (in_.transmission_weight > 0) return;  // there the index bends light
    const float f0 = min(sqr((ior - 1) / (ior + 1)) * luminance(color), 0.99f);
    m().ior = (1 + std::sqrt(f0)) / (1 - std::sqrt(f0));
  }

  void set_layers() {
    m().coat_weight = in_.coat_weight;
    m().coat_roughness = in_.coat_roughness;
    m().coat_ior = kCoatIor;
    m().coat_darkening = 0;  // glTF's coat dims the base by its reflection only
    if (in_.coat_weight > 0) {
      m().textures.coat_weight = row_of(in_.coat_weight_texture, "coat weight");
      m().textures.coat_roughness = row_of(in_.coat_roughness_texture, "coat roughness");
    }
    if (m().coat_weight > 0 && in_.coat_normal_texture.ok())
      leave_out("the coat's normal map is ignored: the coat uses the base's");
    m().fuzz_weight = in_.fuzz_weight;
    m().fuzz_color = in_.fuzz_color * mean_color_of(in_.fuzz_color_texture, "sheen colour");
    m().fuzz_roughness =
        in_.fuzz_roughness * mean_of(in_.fuzz_roughness_texture, "sheen roughness");
    m().anisotropy = in_.anisotropy;
    m().anisotropy_rotation = in_.anisotropy_rotation / (2 * kPi);
    if (in_.anisotropy > 0 && in_.anisotropy_texture.ok())
      leave_out("its anisotropy texture is ignored");
  }

  /// glTF and MTL colour light that goes through by the base colour, once; the renderer colours it
  /// either at the surface or with depth.
  void set_transmission() {
    m().transmission_weight = in_.transmission_weight;
    if (!(m().transmission_weight > 0)) return;
    m().textures.transmission = row_of(in_.transmission_texture, "transmission");
    m().thin_walled = in_.thin_walled;
    Vec3f tint = in_.base_color;
    if (textures_->has(in_.base_color_texture)) {
      tint = tint * textures_->mean(in_.base_color_texture);
      leave_out("transmitted light is coloured by the mean of its base colour texture");
    }
    if (in_.thin_walled || !(in_.transmission_depth > 0)) {
      m().transmission_color = tint;
      return;
    }
    m().transmission_color = in_.transmission_color;
    m().transmission_depth = in_.transmission_depth * scale_;
    if (luminance(tint) < 0.99f)
      leave_out("transmitted light is coloured with depth, not by its base colour");
  }

  void set_emission() {
    m().emission = in_.emission;
    m().emits_outwards = !in_.double_sided;
    m().textures.emission = row_of(in_.emission_texture, "emission");
    if (!in_.unlit) return;
    m().emission = in_.base_color * kWhiteLuminance;
    m().textures = {.base_color = m().textures.base_color, .opacity = m().textures.opacity};
    m().glows_in_color = true;
    m().emits_outwards = false;
    m().base_color = {0, 0, 0};
    m().metallic = m().specular_weight = m().coat_weight = m().fuzz_weight = 0;
    m().transmission_weight = 0;
  }

  void set_relief() {
    MaterialTextures& map = m().textures;
    const bool is_normals =
        !textures_->has(in_.normal_texture) && textures_->looks_like_normals(in_.bump_texture);
    TextureRecipe normal{is_normals ? in_.bump_texture : in_.normal_texture};
    normal.source.channel = TextureChannel::kColor;
    normal.normal_scale = is_normals ? in_.bump_scale : in_.normal_scale;
    if (usable(normal.source, "normal")) map.normal = textures_->row(normal);
    if (is_normals) return leave_out("its bump map looks like a normal map and is used as one");
    map.bump = row_of(in_.bump_texture, "bump");
    m().bump_scale = in_.bump_scale * kBumpShare;
    surface_.bump_by_texture = map.bump >= 0;
  }

  const ImportedMaterial& in_;
  const float scale_;
  ImportedTextures* textures_;
  RenderDescription* out_;
  ImportedSurface surface_;
  const TextureRef* reference_ = nullptr;  // texture whose coordinates all textures use
  bool told_nearest_ = false;
};

}  // namespace

ImportedSurface describe_imported(const ImportedMaterial& in, const std::string& name, float scale,
                                  ImportedTextures* textures, RenderDescription* out) {
  return SurfaceMaker(in, name, scale, textures, out).make();
}

ImportedSurface plain_surface(const std::string& name) {
  ImportedSurface out;
  out.material.name = name;
  out.material.imported = true;
  return out;
}

}  // namespace gloam
