#include "render/scene/material_store.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "render/kernel/bsdf/layered_bsdf.h"
#include "world/materials/visual_rules.h"

namespace gloam {
namespace {

bool has_layers(const MaterialDescription& m) {
  return m.anisotropy > 0 || m.transmission_weight > 0 || m.subsurface_weight > 0 ||
         m.coat_weight > 0 || m.fuzz_weight > 0 || m.pattern >= 0 || m.wear >= 0 || m.wetness > 0 ||
         m.dust > 0 || m.snow > 0;
}

MaterialLayers layers_of(const MaterialDescription& in) {
  const auto unit = [](float x) { return clamp(x, 0.0f, 1.0f); };
  const auto color = [&](Vec3f c) { return Vec3f{unit(c.x), unit(c.y), unit(c.z)}; };
  MaterialLayers out;
  out.coat_weight = unit(in.coat_weight);
  out.coat_roughness = unit(in.coat_roughness);
  out.coat_f0 = sqr((in.coat_ior - 1) / (in.coat_ior + 1));
  out.coat_darkening = unit(in.coat_darkening);
  out.coat_color = color(in.coat_color);
  out.fuzz_weight = unit(in.fuzz_weight);
  out.fuzz_roughness = unit(in.fuzz_roughness);
  out.fuzz_color = color(in.fuzz_color);
  out.transmission = unit(in.transmission_weight);
  // Light that is not bent at all has no direction to be sampled about.
  out.ior = std::fabs(in.ior - 1) < 1e-3f ? 1.001f : clamp(in.ior, 1.0f / 3, 3.0f);
  out.thin = in.thin_walled;
  // Below that roughness the lobe is narrower than the kernel's narrowest.
  const float seen = roughness_under_coat(in.roughness, out.coat_roughness, out.coat_weight);
  out.straight = out.thin && out.transmission > 0 && seen < 0.032f;
  const Vec3f through = color(in.transmission_color);
  if (in.transmission_depth > 0 && !out.thin) {
    const auto per_metre = [&](float t) {
      return -std::log(max(t, 1e-4f)) / in.transmission_depth;
    };
    out.absorption = {per_metre(through.x), per_metre(through.y), per_metre(through.z)};
  } else {
    out.tint = through;
  }
  out.subsurface = unit(in.subsurface_weight);
  out.subsurface_color = color(in.subsurface_color);
  out.anisotropy = clamp(in.anisotropy, 0.0f, 0.98f);
  out.cos_rotation = std::cos(2 * kPi * in.anisotropy_rotation);
  out.sin_rotation = std::sin(2 * kPi * in.anisotropy_rotation);
  out.pattern = in.pattern;
  out.wear = in.wear;
  out.wetness = unit(in.wetness);
  out.porosity = unit(in.porosity);
  out.dust = unit(in.dust);
  out.snow = unit(in.snow);
  return out;
}

MaterialView view_of(const MaterialDescription& in, const TextureStore& textures) {
  MaterialView out;
  const auto unit = [](float x) { return clamp(x, 0.0f, 1.0f); };
  out.base_color = {unit(in.base_color.x), unit(in.base_color.y), unit(in.base_color.z)};
  out.emission = {max(in.emission.x, 0), max(in.emission.y, 0), max(in.emission.z, 0)};
  out.emits_outwards = in.emits_outwards;
  out.opacity = unit(in.opacity);
  out.metallic = unit(in.metallic);
  out.roughness = unit(in.roughness);
  const float ior = max(in.ior, 1.0f);
  out.f90 = unit(in.specular_weight);
  out.f0 = sqr((ior - 1) / (ior + 1)) * out.f90;
  out.mapping = in.mapping;
  out.texture_uniform = in.texture_uniform;
  out.texture_repeat = in.texture_repeat;
  out.textures = in.textures;
  out.bump_scale = in.bump_scale;
  out.glows_in_color = in.glows_in_color;
  const MaterialTextures& t = in.textures;
  // The layers look theirs up themselves, and occlusion is traced.
  const int used[] = {t.base_color, t.roughness, t.metallic, t.orm,
                      t.normal,     t.opacity,   t.emission, t.bump};
  out.textured = in.mapping != TextureMapping::kNone &&
                 std::any_of(std::begin(used), std::end(used), [](int i) { return i >= 0; });
  out.transparent = out.opacity < 1 || (in.transmission_weight > 0 && layers_of(in).straight);
  if (out.textured) {
    out.transparent |= t.opacity >= 0 || (t.base_color >= 0 && textures.has_alpha[t.base_color]);
  }
  return out;
}

std::array<float, 4> rgba_at(const std::vector<float>& values, int row) {
  GLOAM_CHECK(values.size() >= 4 * (static_cast<size_t>(row) + 1), "the pose frame lacks a colour");
  std::array<float, 4> rgba;
  std::copy_n(values.begin() + 4 * row, 4, rgba.begin());
  return rgba;
}

/// The described material with colour `rgba` and everything else as the frame has it.
MaterialView live_view(const MaterialDescription& described, const std::array<float, 4>& rgba,
                       const PoseFrame& frame, const TextureStore& textures) {
  ModelSurface surface;
  surface.rgba = rgba;
  if (described.model_material >= 0) {
    const auto m = static_cast<size_t>(described.model_material);
    surface.emission = frame.material_emission[m];
    surface.specular = frame.material_specular[m];
    surface.shininess = frame.material_shininess[m];
    surface.reflectance = frame.material_reflectance[m];
    surface.metallic = frame.material_metallic[m];
    surface.roughness = frame.material_roughness[m];
  }
  MaterialDescription live = described;
  set_look(surface, &live);
  return view_of(live, textures);
}

}  // namespace

MaterialStore::MaterialStore(const RenderDescription& description, const TextureStore& textures) {
  const bool outdoors = description.weather.covers_surfaces();
  for (const MaterialDescription& material : description.materials) {
    const bool layered = outdoors || has_layers(material);
    layer_rows_.push_back(layered ? static_cast<int>(layers_.size()) : -1);
    if (layered) layers_.push_back(layers_of(material));
    views_.push_back(view_of(material, textures));
    views_.back().layers = layer_rows_.back();
    emission_.push_back(views_.back().emission);
  }
}

void MaterialStore::dim(const RenderDescription& description,
                        const std::vector<LightLevel>& levels) {
  for (size_t i = 0; i < levels.size(); ++i) {
    if (description.materials[i].schedule < 0) continue;
    views_[i].emission = emission_[i] * levels[i].mean;
    views_[i].levels = levels[i].row;
  }
}

bool MaterialStore::update(const RenderDescription& description, const TextureStore& textures,
                           const PoseFrame& frame, std::vector<InstanceView>* instances) {
  if (frame.live_serial == live_serial_) return false;
  live_serial_ = frame.live_serial;
  const std::vector<MaterialDescription>& materials = description.materials;
  if (live_serial_ == 0) {
    *this = MaterialStore(description, textures);
  } else {
    views_.resize(materials.size());
    for (size_t i = 0; i < materials.size(); ++i) {
      const MaterialDescription& in = materials[i];
      const bool own = in.own_color || in.model_material < 0;
      const auto rgba = own ? in.rgba : rgba_at(frame.material_rgba, in.model_material);
      // Materials of rendered things that are not simulated never change.
      const bool is_live = in.model_material >= 0;
      views_[i] = is_live ? live_view(in, rgba, frame, textures) : view_of(in, textures);
      views_[i].layers = layer_rows_[i];
      emission_[i] = views_[i].emission;
    }
  }
  for (size_t i = 0; i < instances->size(); ++i) {
    const InstanceDescription& in = description.instances[i];
    const MaterialDescription& material = materials[static_cast<size_t>(in.material)];
    InstanceView& out = (*instances)[i];
    out.material = static_cast<uint32_t>(in.material);
    if (in.geom < 0 || live_serial_ == 0) continue;
    const auto rgba = rgba_at(frame.geom_rgba, in.geom);
    const bool own_color = material.model_material < 0 || !is_default_rgba(rgba.data());
    if (own_color == material.own_color && (!own_color || rgba == material.rgba)) continue;
    out.material = static_cast<uint32_t>(views_.size());
    views_.push_back(live_view(
        material, own_color ? rgba : rgba_at(frame.material_rgba, material.model_material), frame,
        textures));
    views_.back().layers = layer_rows_[static_cast<size_t>(in.material)];
  }
  return true;
}

}  // namespace gloam
