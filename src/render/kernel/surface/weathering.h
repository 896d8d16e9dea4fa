#pragma once
// Water, dust and snow on any material: pure functions of its parameters. Layers lie on what was
// there before: wet first, then dust, then snow. Device-safe.

#include "render/kernel/math/noise.h"

namespace gloam {

/// The parameters that weather changes, named as in OpenPBR.
struct WeatheredMaterial {
  Vec3f base_color{0.5f, 0.5f, 0.5f};
  float metallic = 0, roughness = 0.5f;
  float coat_weight = 0, coat_ior = 1.5f, coat_roughness = 0.1f;
  float fuzz = 0;
  float bump = 1;   ///< scale of the height gradients beneath, 0..1: water and snow level them
  float water = 0;  ///< fraction that lies under a puddle
};

namespace weathering {

/// Lays `cover` of a surface of the layer's own over m: every field is the mean by area.
GLOAM_HD WeatheredMaterial cover(const WeatheredMaterial& m, const WeatheredMaterial& layer,
                                 float cover) {
  // Coat parameters only count by the coat's weight.
  const float coat = lerp(m.coat_weight, layer.coat_weight, cover);
  const float t = coat > 0 ? cover * layer.coat_weight / coat : cover;
  return {lerp(m.base_color, layer.base_color, cover),
          lerp(m.metallic, layer.metallic, cover),
          lerp(m.roughness, layer.roughness, cover),
          coat,
          lerp(m.coat_ior, layer.coat_ior, t),
          lerp(m.coat_roughness, layer.coat_roughness, t),
          lerp(m.fuzz, layer.fuzz, cover),
          lerp(m.bump, layer.bump, cover),
          lerp(m.water, layer.water, cover)};
}

/// Cosine of the unit normal with +z; degenerate normals count as level.
GLOAM_HD float upwards(Vec3f n) {
  const float n2 = dot(n, n);
  return n2 > 1e-12f && n2 < 1e12f ? n.z / sqrtf(n2) : 1.0f;
}

/// Albedo of a porous surface of dry albedo `a` when water fills `pores` (0..1) of it. Two effects:
/// between grains in water light scatters more forwards and goes deeper (Twomey, Bohren and
/// Mergenthaler 1986, "Reflectance and albedo differences between wet and dry surfaces"), taken as
/// half the scattering in Kubelka and Munk's K/S = (1 - a)² / 2a, which gives sands the measured
/// half of their albedo; and what comes out is in part thrown back inside at the water's surface
/// and absorbed anew (Lekner and Dorf 1988, "Why some things are darker when wet"): (1 - p) a / (1
/// - p a), p = 0.474 for diffuse light inside n = 4/3. What the water reflects itself is the
/// coat's.
GLOAM_HD float wet_albedo(float a, float pores) {
  constexpr float kInside = 0.474f;
  const float ratio = sqr(1.0f - a) / max(a, 1e-4f);  // K / S with half the scattering
  const float deep = 1.0f / (1.0f + ratio + sqrtf(ratio * ratio + 2.0f * ratio));
  return lerp(a, min(deep * (1.0f - kInside) / (1.0f - kInside * deep), a), pores);
}

}  // namespace weathering

struct Wetness {
  float amount = 0;       ///< 0 dry, 0.5 soaked without a film, 1 all under water where level
  float porosity = 0.8f;  ///< 0 glass and metal, 0.8 concrete, brick and wood, 1 soil
  uint32_t seed = 0;
};

/// Damp first darkens what is porous; then a film smooths it (after Lagarde 2013, "Water drop 3b –
/// Physically based wet surfaces"); last puddles stand on level ground, first where the ground is
/// low: `relief` = height there over the mean, in [-1, 1]. `p` [m] and `footprint` [m] break the
/// puddles' borders, metres across.
GLOAM_HD WeatheredMaterial apply_wetness(WeatheredMaterial m, const Wetness& w, Vec3f p, Vec3f n,
                                         float relief, float footprint) {
  if (w.amount <= 0) return m;
  const float soaked = smooth_step(0.0f, 0.5f, w.amount), film = smooth_step(0.3f, 1.0f, w.amount);
  const float pores = soaked * w.porosity * (1.0f - m.metallic);
  m.base_color = {weathering::wet_albedo(m.base_color.x, pores),
                  weathering::wet_albedo(m.base_color.y, pores),
                  weathering::wet_albedo(m.base_color.z, pores)};
  // The base's own microfacets meet water, not air: smoother to the eye.
  m.roughness *= 1.0f - 0.35f * pores;
  const WeatheredMaterial wet{
      m.base_color,           m.metallic,        m.roughness, 1.0f, 1.33f, lerp(0.35f, 0.08f, film),
      m.fuzz * (1.0f - film), 1.0f - 0.4f * film};
  m = weathering::cover(m, wet, film * 0.85f);
  const float level = smooth_step(0.94f, 0.99f, weathering::upwards(n));
  if (w.amount > 0.5f && level > 0) {
    const Noise ground = fbm(p, 0.55f, 4, 0.45f, footprint, w.seed + 1u);
    const float rise = lerp(-2.2f, 3.2f, (w.amount - 0.5f) * 2.0f);
    const float puddle =
        level * soft_step(rise - ground.field.value - 0.8f * clamp(relief, -1.0f, 1.0f),
                          sqrtf(0.01f + ground.lost));
    const WeatheredMaterial water{m.base_color, m.metallic, m.roughness, 1.0f, 1.33f,
                                  0.02f,        0.0f,       0.0f,        1.0f};
    m = weathering::cover(m, water, puddle);
  }
  return m;
}

/// Height [m] of the rings that drops make on level water at `time` [s]: from where each falls a
/// crest runs out at 0.23 m/s, the slowest that gravity and surface tension allow, and is gone
/// after 0.25 s; at most one in every 8 cm. `impacts`: drops that make one, per m² and s.
GLOAM_HD Field rain_rings(Vec3f p, float time, float impacts, float footprint) {
  constexpr float kCell = 0.082f, kSpeed = 0.23f, kLife = 0.25f;  // [m], [m/s], [s]
  constexpr float kWidth = 0.006f, kHeight = 4e-4f;               // of a crest [m]
  Field rings;
  if (!(impacts > 0) || footprint > 4 * kWidth) return rings;
  const float chance = min(impacts * kCell * kCell * kLife, 1.0f);
  const float fade = 1 / (1 + sqr(footprint / kWidth));
  const float u = p.x / kCell, v = p.y / kCell, turns = time / kLife;
  const int cx = static_cast<int>(floorf(u)), cy = static_cast<int>(floorf(v));
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const uint32_t own = hash_cell(cx + i, cy + j, 0, 77u);
      const float turn = turns + hash_unit(own, 0);
      const float count = floorf(turn), age = turn - count;  // fraction of its life
      const uint32_t h = hash_cell(cx + i, cy + j, static_cast<int>(count) + 1, 78u);
      if (!(hash_unit(hash_cell(cx + i, cy + j, static_cast<int>(count) + 1, 79u), 0) < chance))
        continue;
      const float dx = (u - static_cast<float>(cx + i) - hash_unit(h, 0)) * kCell;
      const float dy = (v - static_cast<float>(cy + j) - hash_unit(h, 1)) * kCell;
      const float r = sqrtf(dx * dx + dy * dy) + 1e-6f;
      const float x = (r - kSpeed * kLife * age) / kWidth;
      if (fabsf(x) > 4) continue;
      const float bell = expf(-0.5f * x * x), height = kHeight * (1 - age) * fade;
      // A crest between two troughs.
      const float slope = height * bell * x * (x * x - 3) / kWidth;
      rings = rings + Field{height * bell * (1 - x * x), {slope * dx / r, slope * dy / r, 0}};
    }
  }
  return rings;
}

struct Dust {
  float amount = 0;                  ///< 0 clean, 1 = level surfaces are hidden
  Vec3f color{0.44f, 0.40f, 0.34f};  ///< linear albedo of house dust and fine soil
  uint32_t seed = 0;
};

/// A fine Lambertian layer that settles on what faces up: walls keep a tenth of it.
GLOAM_HD WeatheredMaterial apply_dust(WeatheredMaterial m, const Dust& d, Vec3f p, Vec3f n,
                                      float footprint) {
  if (d.amount <= 0) return m;
  const float up = weathering::upwards(n), settled = 0.1f + 0.9f * sqr(max(up, 0.0f));
  const Noise drift = fbm(p, 6.0f, 4, 0.6f, footprint, d.seed + 1u);
  // Grains cover at random: the bare fraction falls exponentially with their amount.
  const float layer = 3.0f * d.amount / max(1.05f - d.amount, 0.05f) * settled *
                      max(1.0f + 0.25f * drift.field.value, 0.0f);
  const WeatheredMaterial dust{d.color, 0, 1, 0, 1.5f, 1, 0, 0.5f};
  return weathering::cover(m, dust, up > -0.2f ? 1.0f - expf(-0.4f * layer) : 0.0f);
}

struct Snow {
  float amount = 0;  ///< 0 none, 1 = all that faces up is hidden
  uint32_t seed = 0;
};
struct SnowCover {
  WeatheredMaterial material;
  float cover = 0;  ///< of the surface that is under snow
  Field relief;     ///< height of the snow over the surface [m], up to 40 mm, gradient by p
};

/// Fresh snow (albedo 0.9, a touch blue: Warren 1982, "Optical properties of snow") lies where the
/// surface faces up; it starts in patches 20 cm wide and clings to slopes as it grows.
GLOAM_HD SnowCover apply_snow(const WeatheredMaterial& m, const Snow& snow, Vec3f p, Vec3f n,
                              float footprint) {
  SnowCover out{m, 0, {}};
  if (snow.amount <= 0) return out;
  const Noise drift = fbm(p, 5.0f, 5, 0.55f, footprint, snow.seed + 1u);
  const float up = weathering::upwards(n);
  // Slides off beyond 50 to 70 degrees; overhangs stay bare.
  const float hold = smooth_step(lerp(0.6f, 0.3f, snow.amount), lerp(0.95f, 0.6f, snow.amount), up);
  if (hold <= 0) return out;
  const float level = lerp(-3.0f, 4.0f, snow.amount) - 6.0f * (1.0f - hold);
  const Field lies = soft_step(drift.field + level, sqrtf(0.06f + drift.lost));
  const Noise grain = fbm(p, 300.0f, 2, 0.7f, footprint, snow.seed + 9u);
  out.cover = lies.value;
  out.relief = lies * (0.04f * snow.amount) + grain.field * (0.0004f * lies.value);
  const WeatheredMaterial white{{0.88f, 0.9f, 0.92f}, 0, 0.9f, 0, 1.31f, 0.3f, 0.2f, 0.0f};
  out.material = weathering::cover(m, white, lies.value);
  return out;
}

}  // namespace gloam
