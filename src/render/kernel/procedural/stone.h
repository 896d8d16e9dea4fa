#pragma once
// Marble and concrete. Device-safe.

#include "render/kernel/procedural/pattern.h"

namespace gloam {

/// Polished marble after Perlin 1985, "An image synthesizer": veins where a warped noise crosses
/// zero, dense ones near a few great ones, over a cloudy ground. color_a ground (Carrara: about
/// 0.7), color_b veins, `scale` distance of the great veins, `amount` strength of veins.
GLOAM_HD ProceduralSample procedural_marble(const ProceduralDescription& d,
                                            const ProceduralPoint& at) {
  const float f = 1.0f / d.scale;
  const Noise wx = fbm(at.p, 0.9f * f, 2, 0.5f, at.footprint, d.seed + 11u);
  const Noise wy = filtered_noise(at.p, {1.3f * f, 1.3f * f, 1.3f * f}, at.footprint, d.seed + 21u);
  const Vec3f bent = at.p + Vec3f{wx.field.value + 0.3f * wy.field.value, wy.field.value,
                                  wx.field.value - wy.field.value} *
                                (0.17f * d.scale);
  const float foot = 1.4f * at.footprint;  // warping packs the pattern closer
  // Veins follow the bedding, which lies askew: they run long within it.
  const Vec3f leaning{0.62f * bent.x + 0.48f * bent.y - 0.62f * bent.z,
                      0.3f * (0.79f * bent.y - 0.61f * bent.x),
                      0.3f * (0.48f * bent.x + 0.38f * bent.y + 0.79f * bent.z)};
  const Noise great = fbm(leaning, 0.8f * f, 3, 0.45f, foot, d.seed + 31u);
  const Noise small = fbm(leaning, 2.6f * f, 2, 0.5f, foot, d.seed + 41u);
  const auto band = [](const Noise& n, float half, float soft) {
    const float sigma = sqrtf(soft * soft + n.lost);
    return soft_step(n.field.value + half, sigma) - soft_step(n.field.value - half, sigma);
  };
  const float sharp = band(great, 0.03f, 0.035f), halo = band(great, 0.1f, 0.3f);
  const float hair = band(small, 0.012f, 0.025f);
  const float cloud = 0.5f + 0.16f * small.field.value + 0.12f * wx.field.value;
  // Veins come and go.
  const float strength = d.amount * clamp(0.6f + 0.45f * wy.field.value, 0.0f, 1.3f);
  const float vein =
      clamp(strength * (0.6f * sharp + 0.75f * halo + 0.3f * hair * (0.3f + 2.5f * halo)) +
                0.3f * d.variation * cloud,
            0.0f, 1.0f);
  ProceduralSample s;
  s.base_color = lerp(d.color_a, d.color_b, vein);
  s.roughness = clamp(d.roughness + 0.06f * d.variation * (sharp + hair), 0.02f, 1.0f);
  s.metallic = d.metallic;
  s.coat_weight = d.coat;
  s.coat_roughness = d.coat_roughness;
  return s;
}

/// Fair-faced concrete: stains of four sizes, fine grain, air pores, run-off streaks down walls;
/// with size_u > 0 the seams and tie holes of formwork panels. color_a mean (dry: 0.3 to 0.4),
/// color_b stains, color_c pores and seams; `amount` of pores, `scale` largest stain.
GLOAM_HD ProceduralSample procedural_concrete(const ProceduralDescription& d,
                                              const ProceduralPoint& at) {
  const float f = 1.0f / d.scale, foot = at.footprint;
  const patterns::SurfaceFrame on = patterns::SurfaceFrame::at(at.p, at.n);
  const Noise stain = fbm(at.p, f, 3, 0.62f, foot, d.seed + 1u);
  const Noise grain = fbm(at.p, 180.0f, 2, 0.7f, foot, d.seed + 5u);
  const Noise streak = filtered_noise(at.p, {14.0f, 14.0f, 0.9f}, foot, d.seed + 9u);
  float tone = 0.5f + d.variation * (0.26f * stain.field.value + 0.1f * grain.field.value +
                                     0.1f * streak.field.value);
  // Pores: 3 to 10 mm apart by two sizes, at most 4 mm across.
  const patterns::Dots big =
      patterns::dots(on.u * 28.0f, on.v * 28.0f, 0.11f, 0.5f * d.amount, foot * 28.0f, d.seed);
  const patterns::Dots fine = patterns::dots(on.u * 95.0f, on.v * 95.0f, 0.12f, 0.55f * d.amount,
                                             foot * 95.0f, d.seed + 3u);
  float dark = 1.0f - (1.0f - big.coverage) * (1.0f - 0.8f * fine.coverage);
  ProceduralSample s;
  const auto pit = [&](const Field& bowl, float per_metre, float depth) {
    return Field{
        -depth * bowl.value,
        (on.along_u * bowl.gradient.x + on.along_v * bowl.gradient.y) * (-depth * per_metre)};
  };
  s.relief = grain.field * 0.00006f + pit(big.bowl, 28.0f, d.depth) +
             pit(fine.bowl, 95.0f, 0.4f * d.depth);
  if (d.size_u > 0 && d.size_v > 0) {
    const float width = max(foot, d.bevel);
    const Field body = patterns::unit_coverage(on.field_u(), d.size_u, d.gap, width) *
                       patterns::unit_coverage(on.field_v(), d.size_v, d.gap, width);
    s.relief = s.relief + (body - 1.0f) * d.depth;
    dark = 1.0f - (1.0f - dark) * (0.35f + 0.65f * body.value);
    // Each panel cast a shade of its own; four tie holes of 25 mm at its quarters.
    const uint32_t h = hash_cell(patterns::repeat(on.u, d.size_u).index,
                                 patterns::repeat(on.v, d.size_v).index, 7, d.seed);
    tone += 0.3f * d.variation * (hash_unit(h, 0) - 0.5f) *
            patterns::detail_left(foot, min(d.size_u, d.size_v));
    const float hu = 0.5f * d.size_u, hv = 0.5f * d.size_v;
    const float du = patterns::repeat(on.u, hu).offset - 0.5f * hu;
    const float dv = patterns::repeat(on.v, hv).offset - 0.5f * hv;
    constexpr float kRadius = 0.0125f;
    const float wide = sqrtf(sqr(kRadius) + 0.25f * foot * foot);
    const float left = patterns::detail_left(foot, min(hu, hv));
    const float r = sqrtf(du * du + dv * dv);
    const float edge = max(0.002f, 0.5f * foot);
    const float hole = clamp((wide - r) / (2.0f * edge) + 0.5f, 0.0f, 1.0f) * sqr(kRadius / wide);
    const float all = lerp(kPi * sqr(kRadius) / (hu * hv), hole, left);
    dark = 1.0f - (1.0f - dark) * (1.0f - 0.85f * all);
    const float slope =
        hole > 0 && hole < 1 && r > 1e-6f ? left / (2.0f * edge * r) * sqr(kRadius / wide) : 0;
    s.relief = s.relief + Field{-hole * left, (on.along_u * du + on.along_v * dv) * slope} * 0.012f;
  }
  s.base_color = lerp(lerp(d.color_a, d.color_b, clamp(tone, 0.0f, 1.0f)), d.color_c, dark);
  s.roughness =
      clamp(d.roughness + 0.08f * d.variation * stain.field.value + 0.1f * dark, 0.05f, 1.0f);
  s.metallic = d.metallic;
  s.coat_weight = d.coat;
  s.coat_roughness = d.coat_roughness;
  return s;
}

}  // namespace gloam
