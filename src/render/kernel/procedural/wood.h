#pragma once
// Wood cut from logs, solid or in boards. Device-safe.

#include "render/kernel/math/ray.h"
#include "render/kernel/procedural/pattern.h"

namespace gloam {
namespace woods {

/// A piece of a log: (x, y) across the log from its middle, z along the grain [m].
struct LogPoint {
  Vec3f q;
  Vec3f x, y, z;         ///< the log's axes in the material's frame
  float tone = 0;        ///< shade of this board, about 0, at most ±0.5
  Field seam{1, {}};     ///< 1 inside a board, 0 in the joint
  float seam_cover = 0;  ///< of the footprint
};

GLOAM_HD LogPoint solid(const ProceduralDescription& d, const ProceduralPoint& at) {
  const float l2 = dot(d.axis, d.axis);
  const Frame frame = Frame::from_z(l2 > 1e-12f ? d.axis * (1.0f / sqrtf(l2)) : Vec3f{0, 0, 1});
  LogPoint log{frame.to_local(at.p), frame.x, frame.y, frame.z};
  log.q.x += 0.8f * d.pith;
  log.q.y += 0.6f * d.pith;
  return log;
}

/// Boards along u, each row shifted at random, each cut from a log of its own.
GLOAM_HD LogPoint board(const ProceduralDescription& d, const ProceduralPoint& at) {
  const patterns::SurfaceFrame on = patterns::SurfaceFrame::at(at.p, at.n);
  const patterns::Repeat row = patterns::repeat(on.v, d.size_v);
  const float shift = d.size_u * hash_unit(hash_cell(row.index, 0, 0x57, d.seed), 0);
  Field u = on.field_u();
  u.value += shift;
  const patterns::Repeat piece = patterns::repeat(u.value, d.size_u);
  const uint32_t h = hash_cell(row.index, piece.index, 0x58, d.seed), g = mix_bits(h + 1u);
  const float out = d.pith * (0.25f + 1.5f * hash_unit(h, 1));
  float s, c;
  sincos_turn(hash_unit(h, 0), &s, &c);
  const float v = row.offset - 0.5f * d.size_v;
  LogPoint log;
  log.q = {c * v - s * on.across + out, s * v + c * on.across,
           piece.offset + 30.0f * hash_unit(g, 0)};
  log.x = on.along_v * c - on.outwards * s;
  log.y = on.along_v * s + on.outwards * c;
  log.z = on.along_u;
  log.tone = (hash_unit(g, 1) - 0.5f) * patterns::detail_left(at.footprint, 1.5f * d.size_v);
  const auto coverage = [&](float width) {
    return patterns::unit_coverage(u, d.size_u, d.gap, width) *
           patterns::unit_coverage(on.field_v(), d.size_v, d.gap, width);
  };
  log.seam = coverage(max(at.footprint, d.bevel));
  log.seam_cover = 1.0f - log.seam.value;
  return log;
}

/// Share of late wood in a ring seen through `width` rings: it grows as t³ over the year and ends
/// sharply. Mean 1/4.
GLOAM_HD Field late_wood(Field rings, float width) {
  const float w = max(width, 0.06f);
  const auto year = [](float t) { return t - floorf(t); };
  const auto below = [&](float t) { return 0.25f * (floorf(t) + sqr(sqr(year(t)))); };
  const auto at = [&](float t) { return year(t) * sqr(year(t)); };
  const float t = year(rings.value), lo = t - 0.5f * w, hi = t + 0.5f * w;
  return compose(rings, (below(hi) - below(lo)) / w, (at(hi) - at(lo)) / w);
}

}  // namespace woods

/// Rings about a wobbling middle, years of different shade, fibres and pores along the grain and,
/// by `amount`, the rays of oak. size_u > 0: boards. color_a early wood, color_b late wood,
/// color_c pores and seams, `scale` mean ring width.
GLOAM_HD ProceduralSample procedural_wood(const ProceduralDescription& d,
                                          const ProceduralPoint& at) {
  const woods::LogPoint log =
      d.size_u > 0 && d.size_v > 0 ? woods::board(d, at) : woods::solid(d, at);
  const float foot = at.footprint;
  const Vec3f q = log.q;
  const auto to_material = [&](Vec3f g) { return log.x * g.x + log.y * g.y + log.z * g.z; };
  // The trunk bends and swells over decimetres; rings bulge locally.
  const Noise bend = fbm(q, {5.0f, 5.0f, 0.9f}, 2, 0.4f, foot, d.seed + 1u);
  const float radius = sqrtf(q.x * q.x + q.y * q.y), inv = 1.0f / max(radius, 1e-4f);
  const float wobble = 0.012f + 0.6f * d.scale;  // [m]
  const Vec3f slope_log = Vec3f{q.x * inv, q.y * inv, 0} + bend.field.gradient * wobble;
  const Field rings = Field{radius + wobble * bend.field.value, slope_log} * (1.0f / d.scale);
  // Rings cut at a slant are wide on the surface: the footprint in rings is the projected one.
  const Vec3f slope = patterns::in_surface(to_material(slope_log), at.n);
  const float blur =
      sqrtf(sqr(foot * length(slope) / d.scale) + 12.0f * bend.lost * sqr(wobble / d.scale));
  const Field late_field = woods::late_wood(rings, blur);
  const float late = late_field.value;
  // Good and bad years, over about five rings.
  const Noise years =
      filtered_noise({rings.value * 0.21f, 0, 0}, {1, 1, 1}, blur * 0.21f, d.seed + 5u);
  const Noise fibre = filtered_noise(q, {1400.0f, 1400.0f, 26.0f}, foot, d.seed + 7u);
  const Noise streak = filtered_noise(q, {150.0f, 150.0f, 2.2f}, foot, d.seed + 9u);
  const Noise pore = filtered_noise(q, {1700.0f, 1700.0f, 55.0f}, foot, d.seed + 10u);
  const float pore_sigma = sqrtf(0.12f + pore.lost);
  const Field pores = soft_step(pore.field - late_field * 0.5f - 1.75f, pore_sigma);
  float ray = 0;
  const float ray_left = noise_left(foot * 1400.0f);
  if (d.amount > 0 && ray_left > 0) {
    // Thin sheets through the middle of the log: a noise of the direction from there.
    const float around = 220.0f;  // rays per turn / 2π
    const Noise sheet = filtered_noise({q.x * inv * around, q.y * inv * around, q.z * 45.0f},
                                       {1, 1, 1}, foot * min(1400.0f, around * inv), d.seed + 12u);
    ray = d.amount * (soft_step(sheet.field.value - 1.7f, sqrtf(0.04f + sheet.lost)) - 0.045f);
  }
  const float body = clamp(
      0.12f + 0.95f * late * (1.0f + 0.35f * years.field.value) +
          d.variation * (0.07f * years.field.value + 0.1f * streak.field.value + 0.9f * log.tone) +
          0.07f * fibre.field.value,
      0.0f, 1.0f);
  Vec3f color = lerp(d.color_a, d.color_b, body);
  color = lerp(color, d.color_c, 0.5f * clamp(pores.value, 0.0f, 1.0f));
  color = color * (1.0f + 0.35f * ray);
  ProceduralSample s;
  s.base_color = lerp(color, d.color_c, log.seam_cover);
  const Field grain = fibre.field * 0.000008f - pores * 0.00003f;
  s.relief = Field{grain.value, to_material(grain.gradient)} + (log.seam - 1.0f) * d.depth;
  s.roughness = clamp(lerp(d.roughness + 0.08f * (pores.value - 0.05f) - 0.06f * (late - 0.25f),
                           d.gap_roughness, log.seam_cover),
                      0.03f, 1.0f);
  s.metallic = d.metallic;
  s.coat_weight = d.coat * (1.0f - log.seam_cover);
  s.coat_roughness = d.coat_roughness;
  return s;
}

}  // namespace gloam
