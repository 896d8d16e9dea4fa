#pragma once
// Woven cloth. Device-safe.

#include "render/kernel/procedural/pattern.h"

namespace gloam {
namespace fabrics {

/// Whether the warp (yarns along v) lies on top at the crossing (column, row).
GLOAM_HD bool warp_on_top(Weave weave, int column, int row) {
  return weave == Weave::kPlain ? ((column + row) & 1) == 0 : ((column - row) & 3) < 2;
}

/// Share of the crossings in the square of `width` < 3 crossings about (u, v) at which the weft
/// lies on top, by area.
GLOAM_HD float weft_coverage(Weave weave, const CellSplit& u, const CellSplit& v, float width) {
  const float half = 0.5f * width;
  float sum = 0;
  for (int y = -2; y <= 2; ++y) {
    const float top = static_cast<float>(y) - v.f;
    const float high = min(top + 1.0f, half) - max(top, -half);
    for (int x = -2; x <= 2 && high > 0; ++x) {
      const float left = static_cast<float>(x) - u.f;
      const float wide = min(left + 1.0f, half) - max(left, -half);
      if (wide > 0 && !warp_on_top(weave, u.cell + x, v.cell + y)) sum += wide * high;
    }
  }
  return sum / (width * width);
}

}  // namespace fabrics

/// Warp (color_a) and weft (color_b) yarns `scale` apart, plain or 2/2 twill. Near by each yarn is
/// a twisted bundle that dips under others; from afar what is left is the mean colour with the
/// slubs of single yarns. `depth` height of yarns over gaps [m], `variation` of yarns, `fuzz`
/// sheen.
GLOAM_HD ProceduralSample procedural_fabric(const ProceduralDescription& d,
                                            const ProceduralPoint& at) {
  const patterns::SurfaceFrame on = patterns::SurfaceFrame::at(at.p, at.n);
  const float foot = at.footprint, cells = foot / d.scale, f = 1.0f / d.scale;
  const CellSplit cu = split_cell(on.u * f), cv = split_cell(on.v * f);
  const bool warp = fabrics::warp_on_top(d.weave, cu.cell, cv.cell);
  const float side = (warp ? cu.f : cv.f) - 0.5f;
  // The float: how many crossings the top yarn stays on top, and where along it this one is.
  const int step_u = warp ? 0 : 1, step_v = warp ? 1 : 0;
  const bool before = fabrics::warp_on_top(d.weave, cu.cell - step_u, cv.cell - step_v) == warp;
  const bool after = fabrics::warp_on_top(d.weave, cu.cell + step_u, cv.cell + step_v) == warp;
  const float length = 1.0f + (before ? 1.0f : 0.0f) + (after ? 1.0f : 0.0f);
  const float run = (warp ? cv.f : cu.f) + (before ? 1.0f : 0.0f) - 0.5f * length;
  const float a = 2.0f * run / length;
  // Heights are 0 on all borders of floats, so that neighbours meet.
  const float round = 1.0f - 4.0f * side * side, dip = 1.0f - sqr(a * a);
  const float near = noise_left(2.2f * cells);
  const Vec3f across = warp ? on.along_u : on.along_v, along = warp ? on.along_v : on.along_u;
  ProceduralSample s;
  Field height{round * dip,
               (across * (-8.0f * side * dip) + along * (-8.0f * a * a * a / length * round)) * f};
  constexpr float kMeanHeight = 8.0f / 15.0f;  // 2/3 across, 4/5 along
  // Fibres twist about the yarn: slanted furrows, six across.
  const float twist_near = noise_left(7.0f * cells);
  const Noise furrow = filtered_noise(
      across * ((side + (warp ? static_cast<float>(cu.cell) : static_cast<float>(cv.cell))) * 6.0f -
                run * 4.0f) +
          along * (run * 1.5f),
      {1, 1, 1}, 7.0f * cells, d.seed + 3u);
  const float shade = 1.0f + near * 0.75f * (height.value - kMeanHeight) +
                      0.16f * twist_near * furrow.field.value * round;
  // Slubs: each yarn thickens and fades along its length, over about 60 yarns.
  const float yarn_left = noise_left(1.6f * cells);
  const auto slub = [&](float yarn, float along_yarn, uint32_t seed) {
    const float line = static_cast<float>(
        static_cast<int>(hash_cell(static_cast<int>(yarn), 0, 9, seed) & 0xFFFu));
    return gradient_noise({along_yarn * f * (1.0f / 60.0f), line * 1.37f + 0.5f, 0.5f}, seed).value;
  };
  float tone = 0;
  if (yarn_left > 0) {
    tone = yarn_left * (warp ? slub(static_cast<float>(cu.cell), on.v, d.seed + 1u)
                             : slub(static_cast<float>(cv.cell), on.u, d.seed + 2u));
  }
  const Noise wear = fbm(at.p, 7.0f, 2, 0.5f, foot, d.seed + 7u);
  const float pattern = 1.0f - smooth_step(1.5f, 3.0f, cells);
  float weft_coverage = 0.5f;
  if (pattern > 0) {
    weft_coverage = lerp(0.5f, fabrics::weft_coverage(d.weave, cu, cv, max(cells, 0.02f)), pattern);
  }
  s.base_color =
      lerp(d.color_a, d.color_b, weft_coverage) *
      max(shade * (1.0f + d.variation * (0.16f * tone + 0.05f * wear.field.value)), 0.0f);
  s.roughness = d.roughness;
  s.fuzz = d.fuzz;
  s.coat_roughness = d.coat_roughness;
  s.relief = height * (d.depth * near) + d.depth * kMeanHeight * (1.0f - near);
  return s;
}

}  // namespace gloam
