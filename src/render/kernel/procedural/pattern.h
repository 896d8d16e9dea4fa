#pragma once
// Parts that all families of procedural materials fraction: the sample, the projection onto a
// surface, and filtered patterns of repeated units. Device-safe.

#include "render/kernel/math/noise.h"
#include "world/materials/procedural_description.h"

namespace gloam {

/// Point at which a procedural material is asked for, in the frame that it is fixed to.
struct ProceduralPoint {
  Vec3f p;              ///< [m]
  Vec3f n{0, 0, 1};     ///< unit normal; anything else is taken as one
  float footprint = 0;  ///< width of the square that is averaged over [m]; >= 0
  float convexity = 0;  ///< dirt: -1 = narrow corner, 0 = flat, 1 = sharp edge
  float height = 1;     ///< dirt: above the floor [m]
};

struct ProceduralSample {
  Vec3f base_color{0.5f, 0.5f, 0.5f};
  float roughness = 0.5f, metallic = 0;
  float coat_weight = 0, coat_roughness = 0;
  float fuzz = 0;  ///< weight of sheen
  float mask = 1;  ///< scratches and dirt: how much of them is here, to lay over another
  Field relief;    ///< height along the normal [m] and its gradient by p [m/m]
};

namespace patterns {

/// Coordinates on the surface: p = u along_u + v along_v + across outwards.
struct SurfaceFrame {
  float u, v, across;
  Vec3f along_u, along_v, outwards;
  GLOAM_HD static SurfaceFrame at(Vec3f p, Vec3f n) {
    const float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
    if (x > y && x > z) return {p.y, p.z, p.x, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    if (y > z) return {p.x, p.z, p.y, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
    return {p.x, p.y, p.z, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  }
  GLOAM_HD Field field_u() const { return {u, along_u}; }
  GLOAM_HD Field field_v() const { return {v, along_v}; }
};

/// The part of the gradient g that lies in the surface of normal n, which is not 0.
GLOAM_HD Vec3f in_surface(Vec3f g, Vec3f n) { return g - n * (dot(g, n) / dot(n, n)); }

/// Unit interval t in [0, 1) after the integer part, and that part.
struct Repeat {
  int index;
  float offset;  ///< from the unit's low border, in the unit's own measure
};
GLOAM_HD Repeat repeat(float x, float period) {
  const CellSplit s = split_cell(x / period);
  return {s.cell, s.f * period};
}

/// Share of [x - width/2, x + width/2] that lies inside units, which repeat with `period` and leave
/// a `gap` centred on each border: exact for any width > 0.
GLOAM_HD Field unit_coverage(Field x, float period, float gap, float width) {
  const float t = repeat(x.value, period).offset, body = period - gap, half = 0.5f * gap;
  const auto inside_below = [&](float y) {  // length inside units from 0 to y
    const float turns = floorf(y / period);
    return turns * body + clamp(y - turns * period - half, 0.0f, body);
  };
  const auto inside = [&](float y) {
    const float r = y - floorf(y / period) * period;
    return r > half && r < period - half ? 1.0f : 0.0f;
  };
  const float w = max(width, 1e-6f), lo = t - 0.5f * w, hi = t + 0.5f * w;
  return compose(x, clamp((inside_below(hi) - inside_below(lo)) / w, 0.0f, 1.0f),
                 (inside(hi) - inside(lo)) / w);
}

/// Share of details of size `length` that a footprint leaves: 1 below a fifth, 0 from 1.3 on.
GLOAM_HD float detail_left(float footprint, float length) {
  return 1.0f - smooth_step(0.2f, 1.3f, footprint / length);
}

/// Round dots, at most one per square cell and wholly inside it, of radius up to `radius` <= 0.25
/// [cells]: `presence` = fraction of cells that have one. Coverage as seen through `footprint`
/// [cells].
struct Dots {
  float coverage;
  Field bowl;  ///< depth of a paraboloid in each dot, 0..1; gradient per cell in (x, y)
};
GLOAM_HD Dots dots(float x, float y, float radius, float presence, float footprint, uint32_t seed) {
  const CellSplit cx = split_cell(x), cy = split_cell(y);
  const float mean = presence * kPi * sqr(radius) * 0.4333f;  // of r²: r = radius (0.3 + 0.7 u²)
  const float left = detail_left(footprint, 1.0f);
  Dots out{mean * (1.0f - left), {}};
  const uint32_t h = hash_cell(cx.cell, cy.cell, 0x51, seed), g = mix_bits(h + 1u);
  if (left <= 0.0f || hash_unit(h, 0) >= presence) return out;
  const float r = radius * (0.3f + 0.7f * sqr(hash_unit(h, 1)));
  const float dx = cx.f - (radius + (1.0f - 2.0f * radius) * hash_unit(g, 0));
  const float dy = cy.f - (radius + (1.0f - 2.0f * radius) * hash_unit(g, 1));
  const float d2 = dx * dx + dy * dy;
  // A disc blurred to a wider and fainter one, of the same volume.
  const float wide = sqrtf(r * r + 0.25f * sqr(footprint)), faint = sqr(r / wide);
  const float t = 1.0f - d2 / sqr(2.0f * wide);
  if (footprint < 0.2f * r) {
    out.coverage = d2 < r * r ? 1.0f : 0.0f;
  } else if (t > 0) {
    out.coverage +=
        left * faint * 0.75f * t * t;  // integral of t² over the disc of 2 wide: 4/3 π wide²
  }
  const float deep = 1.0f - d2 / sqr(r);
  if (deep > 0) {
    const float keep = left * faint;
    out.bowl = {deep * deep * keep,
                {-4.0f * dx / sqr(r) * deep * keep, -4.0f * dy / sqr(r) * deep * keep, 0}};
  }
  return out;
}

}  // namespace patterns
}  // namespace gloam
