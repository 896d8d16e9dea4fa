#pragma once
// Scratches and dirt: on their own, or by their `mask` over another material. Device-safe.

#include "render/kernel/procedural/pattern.h"

namespace gloam {
namespace wearing {

struct Scratches {
  float coverage = 0;  ///< of the footprint
  Field groove;        ///< depth, 0..1
};

/// One layer of straight scratches in lanes `lane` apart, at most one per lane and length, turned
/// by `angle` from u. `length`, `width` [m].
GLOAM_HD Scratches layer(const patterns::SurfaceFrame& on, float angle, float length, float lane,
                         float width, float presence, float footprint, uint32_t seed) {
  const float c = cosf(angle), s = sinf(angle);
  const Vec3f along = on.along_u * c + on.along_v * s, across = on.along_v * c - on.along_u * s;
  const float x = on.u * c + on.v * s, y = on.v * c - on.u * s;
  const CellSplit row = split_cell(y / lane);
  const uint32_t r = hash_cell(row.cell, 0, 0x5C, seed);
  const CellSplit piece = split_cell(x / length + hash_unit(r, 0));
  const uint32_t h = hash_cell(row.cell, piece.cell, 0x5D, seed), g = mix_bits(h + 1u);
  // A scratch takes 30 to 100 % of the piece, fades at both ends, and leans within its lane.
  const float half = 0.5f * (0.3f + 0.7f * hash_unit(h, 1));
  const float mean_coverage = presence * 0.65f * (8.0f / 15.0f) * width / lane;
  const float left = patterns::detail_left(footprint, lane);
  Scratches out{mean_coverage * (1.0f - left), {}};
  if (left <= 0 || hash_unit(h, 0) >= presence) return out;
  const float t = (piece.f - 0.5f) / half;
  if (fabsf(t) >= 1) return out;
  const float lean = (hash_unit(g, 0) - 0.5f) * 0.3f * lane;
  const float middle = 0.5f * lane + (hash_unit(g, 1) - 0.5f) * 0.2f * lane + lean * t;
  const float wide = sqrtf(width * width + footprint * footprint);
  const float fade = sqr(1.0f - t * t), e = (row.f * lane - middle) / wide;  // mean 8/15
  if (fabsf(e) >= 1) return out;
  const float bell = sqr(1.0f - e * e), faint = width / wide;
  // The bell's integral is 16/15 of its half width.
  out.coverage += left * faint * fade * bell * (15.0f / 16.0f);
  const float k = left * faint * faint;
  const Vec3f de = (across - along * (lean / (half * length))) * (1.0f / wide);
  const Vec3f dt = along * (1.0f / (half * length));
  out.groove = {
      fade * bell * k,
      (de * (-4.0f * e * (1.0f - e * e) * fade) + dt * (-4.0f * t * (1.0f - t * t) * bell)) * k};
  return out;
}

}  // namespace wearing

/// Four layers of scratches about the projection of `axis`: `amount` how many, `variation` how far
/// their directions spread (1 = all ways), `scale` longest [m], `gap` width and `depth` [m].
/// color_a clean surface, color_b bottom of a scratch.
GLOAM_HD ProceduralSample procedural_scratches(const ProceduralDescription& d,
                                               const ProceduralPoint& at) {
  const patterns::SurfaceFrame on = patterns::SurfaceFrame::at(at.p, at.n);
  const float au = dot(d.axis, on.along_u), av = dot(d.axis, on.along_v);
  const float main = au * au + av * av > 1e-12f ? atan2f(av, au) : 0.0f;
  float clean = 1;
  ProceduralSample s;
  for (int i = 0; i < 4; ++i) {
    const uint32_t seed = d.seed + 17u * static_cast<uint32_t>(i);
    const float spread =
        (hash_unit(hash_cell(i, 0, 0x5E, d.seed), 0) + static_cast<float>(i)) * 0.25f - 0.5f;
    const float size = 1.0f - 0.2f * static_cast<float>(i);
    const wearing::Scratches l =
        wearing::layer(on, main + spread * kPi * d.variation, d.scale * size,
                       0.035f * d.scale * size, d.gap * size, d.amount, at.footprint, seed);
    clean *= 1.0f - min(l.coverage, 1.0f);
    s.relief = s.relief - l.groove * (d.depth * size);
  }
  s.mask = 1.0f - clean;
  s.base_color = lerp(d.color_a, d.color_b, s.mask);
  s.roughness = lerp(d.roughness, d.gap_roughness, s.mask);
  s.metallic = d.metallic;
  s.coat_weight = d.coat * clean;
  s.coat_roughness = d.coat_roughness;
  return s;
}

/// Grime gathers in corners (convexity < 0), in the splash zone within about 0.3 m of the floor and
/// on what faces up; its border is ragged by noise of size `scale`. `amount` 0 = none, 1 = all
/// covered. color_a clean surface, color_b dirt.
GLOAM_HD ProceduralSample procedural_dirt(const ProceduralDescription& d,
                                          const ProceduralPoint& at) {
  const Noise ragged = fbm(at.p, 1.0f / d.scale, 5, 0.68f, at.footprint, d.seed + 1u);
  const float up = at.n.z / length(at.n);
  const float splash = at.height > 0 ? 1.0f / (1.0f + sqr(at.height / 0.15f)) : 1.0f;
  const float exposure =
      1.3f * splash + 0.6f * max(up, 0.0f) - 1.8f * clamp(at.convexity, -1.0f, 1.0f);
  // ±4 covers the noise: nothing at 0, everything at 1.
  const float level = lerp(-4.0f, 4.0f, d.amount) + exposure * 4.0f * d.amount * (1.0f - d.amount);
  const float sigma = sqrtf(0.8f + ragged.lost);
  ProceduralSample s;
  const Field cover = soft_step(ragged.field + level, sigma);
  s.mask = d.amount > 0 ? cover.value : 0.0f;
  const Noise grain = fbm(at.p, 350.0f, 2, 0.7f, at.footprint, d.seed + 9u);
  s.base_color = lerp(d.color_a, d.color_b * max(1.0f + 0.1f * grain.field.value, 0.0f), s.mask);
  s.roughness = lerp(d.roughness, d.gap_roughness, s.mask);
  s.metallic = d.metallic * (1.0f - s.mask);
  s.coat_weight = d.coat * (1.0f - s.mask);
  s.coat_roughness = d.coat_roughness;
  s.relief = cover * (d.amount > 0 ? d.depth : 0.0f);
  return s;
}

}  // namespace gloam
