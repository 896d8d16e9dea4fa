#pragma once
// Patterns, wear, weather and layers, applied to a surface after its textures. Device-safe.

#include "render/kernel/bsdf/microfacet.h"
#include "render/kernel/surface/baked_lookup.h"
#include "render/kernel/surface/procedural.h"
#include "render/kernel/surface/surface_textures.h"
#include "render/kernel/surface/weathering.h"

namespace gloam {

/// A shading normal that looks away from the viewer is bent back to just face it: black rims and
/// lost energy otherwise. `d`: direction of the view.
template <class F>
GLOAM_HD Vec3Of<F> face_viewer(Vec3Of<F> normal, Vec3Of<F> d) {
  const F facing = -dot(normal, d);
  const MaskOf<F> away = facing < 1e-3f;
  if (!any(away)) return normal;
  return select<F>(away, normalize(normal - d * (1e-2f - facing)), normal);
}

namespace surfaces {

/// Sample of row `row` of the procedural materials, which is row `baked` of those on surfaces.
GLOAM_HD ProceduralSample pattern_at(const SceneView& scene, int row, int baked,
                                     const ProceduralPoint& at) {
  if constexpr (!kOnCard) {
    if (scene.baked.patterns.empty())
      return eval_procedural(scene.procedurals[static_cast<uint32_t>(row)], at);
  }
  return baked_sample(scene.baked, static_cast<uint32_t>(baked), at);
}

/// The pattern of the material, then what has worn it. Returns the relief in the frame G.
GLOAM_HD Field apply_patterns(const SceneView& scene, const MaterialLayers& m,
                              const ProceduralPoint& at, Surface* s) {
  const InstanceView& instance = scene.instances[s->instance];
  Field relief;
  if (m.pattern >= 0) {
    const ProceduralSample own = pattern_at(scene, m.pattern, instance.baked_pattern, at);
    s->base_color *= own.base_color;
    s->roughness = own.roughness;
    s->metallic = own.metallic;
    s->coat_roughness = own.coat_weight > 0 ? own.coat_roughness : s->coat_roughness;
    s->coat_weight = max(s->coat_weight, own.coat_weight);
    s->fuzz_weight = max(s->fuzz_weight, own.fuzz);
    relief = own.relief;
  }
  if (m.wear >= 0) {
    const ProceduralSample worn = pattern_at(scene, m.wear, instance.baked_wear, at);
    s->base_color = lerp(s->base_color, worn.base_color, worn.mask);
    s->roughness = lerp(s->roughness, worn.roughness, worn.mask);
    s->metallic = lerp(s->metallic, worn.metallic, worn.mask);
    s->coat_weight *= 1.0f - worn.mask;
    relief = relief + worn.relief;
  }
  return relief;
}

/// A material's own wetness, dust and snow at a place, and what has fallen there; of the snow what
/// the moving body has not shed.
struct Weathered {
  float wetness = 0, porosity = 0, dust = 0, snow = 0;
  float time = 0, impacts = 0;  ///< of drops, as in FallenView
  GLOAM_HD bool any() const { return wetness + dust + snow > 0; }
};
GLOAM_HD Weathered weathered_at(const SceneView& scene, const MaterialLayers& m, float snow_left,
                                Vec3f p, Vec3f n_W) {
  Weathered out{m.wetness, m.porosity, m.dust, m.snow * snow_left};
  if (!scene.has_fallen()) return out;
  const FallenView& fallen = scene.fallen;
  // Walls lie in the cells of what is above them: those next to them tell.
  const float cell = fallen.shelter.per_metre > 0 ? 1 / fallen.shelter.per_metre : 0.1f;
  const float open = fallen.shelter.open_above(p + n_W * (1.5f * cell), cell);
  out.wetness = max(out.wetness, fallen.wetness * open);
  out.snow = max(out.snow, fallen.snow * open * snow_left);
  out.time = fallen.time;
  out.impacts = fallen.impacts * open;
  return out;
}

/// Rain, dust and snow by where the surface lies and faces in the world. Returns the snow's relief,
/// and in *bump what is left of the relief beneath.
GLOAM_HD Field apply_weather(const Weathered& m, Vec3f n_W, float width, float* bump, Surface* s) {
  WeatheredMaterial w;
  w.base_color = s->base_color;
  w.metallic = s->metallic;
  w.roughness = s->roughness;
  w.coat_weight = s->coat_weight;
  w.coat_ior = (1.0f + sqrtf(s->coat_f0)) / (1.0f - sqrtf(s->coat_f0));
  w.coat_roughness = s->coat_roughness;
  w.fuzz = s->fuzz_weight;
  Wetness wetness;
  wetness.amount = m.wetness;
  wetness.porosity = m.porosity;
  w = apply_wetness(w, wetness, s->p, n_W, 0.0f, width);
  Dust dust;
  dust.amount = m.dust;
  w = apply_dust(w, dust, s->p, n_W, width);
  Snow snow;
  snow.amount = m.snow;
  const SnowCover cover = apply_snow(w, snow, s->p, n_W, width);
  w = cover.material;
  s->base_color = w.base_color;
  s->metallic = w.metallic;
  s->roughness = w.roughness;
  s->coat_weight = w.coat_weight;
  s->coat_f0 = sqr((w.coat_ior - 1.0f) / (w.coat_ior + 1.0f));
  s->coat_roughness = w.coat_roughness;
  s->fuzz_weight = w.fuzz;
  *bump = w.bump;
  if (!(w.water > 0)) return cover.relief;
  return cover.relief + rain_rings(s->p, m.time, m.impacts, width) * w.water;
}

/// Shares of the layers by their textures. `n_G` = unit geometric normal, outwards.
GLOAM_HD void apply_layer_textures(const SceneView& scene, const InstanceView& instance,
                                   const RayHit& hit, Vec3f p_G, Vec3f n_G, float width,
                                   Surface* s) {
  const MaterialView& m = scene.materials[instance.material];
  const MaterialTextures& map = m.textures;
  const bool any = map.coat_weight >= 0 || map.coat_roughness >= 0 || map.transmission >= 0;
  if (!any || m.mapping == TextureMapping::kNone) return;
  const TextureCoordinates at = texture_coordinates(scene, instance, m, hit, p_G, n_G, width);
  if (map.coat_weight >= 0) s->coat_weight *= lookup(scene, m, map.coat_weight, at).rgb.x;
  if (map.coat_roughness >= 0) s->coat_roughness *= lookup(scene, m, map.coat_roughness, at).rgb.x;
  if (map.transmission >= 0) s->transmission *= lookup(scene, m, map.transmission, at).rgb.x;
}

/// Layers of a material, with patterns and weather, at the place of the surface `s`, seen along d
/// by a ray `width` wide there [m].
GLOAM_HD void apply_layers(const SceneView& scene, const RayHit& hit, const Affine3f& X_WG,
                           Vec3f p_G, Vec3f d, float width, float time, Surface* s) {
  const InstanceView& instance = scene.instances[s->instance];
  const MaterialLayers& m =
      scene.layers[static_cast<uint32_t>(scene.materials[instance.material].layers)];
  s->coat_weight = m.coat_weight;
  s->coat_roughness = m.coat_roughness;
  s->coat_f0 = m.coat_f0;
  s->fuzz_weight = m.fuzz_weight;
  s->transmission = m.transmission;
  s->coat_darkening = m.coat_darkening;
  const float side = s->outside ? 1.0f : -1.0f;
  const Vec3f geometric_W = s->geometric * side;  // outwards
  const Vec3f n_G = to_frame(X_WG, geometric_W);
  apply_layer_textures(scene, instance, hit, p_G, n_G, width, s);
  const Weathered weather = weathered_at(scene, m, instance.snow_left, s->p, geometric_W);
  if (m.pattern >= 0 || m.wear >= 0 || weather.any()) {
    ProceduralPoint at{p_G, n_G, width};
    at.height = s->p.z;
    Field relief = apply_patterns(scene, m, at, s);
    relief.gradient = transform_vector(X_WG, relief.gradient);
    if (weather.any()) {
      // Water darkens by what it does to the albedo beneath (wet_albedo).
      const float dry = s->coat_weight * s->coat_darkening;
      float bump;
      const Field snow = apply_weather(weather, geometric_W, width, &bump, s);
      relief = relief * bump + snow;
      s->coat_darkening = s->coat_weight > 0 ? min(dry / s->coat_weight, 1.0f) : 0.0f;
    }
    s->normal = face_viewer(bumped_normal(s->normal * side, relief) * side, d);
  }
  Vec3f u, v;
  if (m.anisotropy > 0 && tangents(scene, instance, hit, p_G, n_G, time, &u, &v)) {
    const Vec3f along = transform_vector(X_WG, u);
    const Vec3f x = along - s->normal * dot(along, s->normal);
    if (length_squared(x) > 0) {
      const Vec3f t = normalize(x);
      s->tangent = t * m.cos_rotation + cross(s->normal, t) * m.sin_rotation;
    }
  }
  if (m.straight) {
    float cos_t;
    const float reflects = fresnel_sheet(fabsf(dot(s->normal, d)), m.ior, &cos_t);
    s->straight = m.tint * (s->transmission * (1.0f - s->metallic) * (1.0f - reflects));
  }
}

}  // namespace surfaces
}  // namespace gloam
