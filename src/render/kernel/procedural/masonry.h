#pragma once
// Bricks and tiles. Device-safe.

#include "render/kernel/procedural/pattern.h"

namespace gloam {

/// Bricks of size_u x size_v [m] with mortar of `gap` around (UK: 215 x 65 and 10 mm; DIN NF: 240 x
/// 71 and 11.5 mm), in running, stack or English bond (rows of stretchers and of headers in turn).
/// color_a and color_b the ends between which bricks vary, color_c mortar; `amount` chips edges,
/// `depth` recess of the mortar, `bevel` rounding of edges.
GLOAM_HD ProceduralSample procedural_brick(const ProceduralDescription& d,
                                           const ProceduralPoint& at) {
  const float foot = at.footprint, pitch_v = d.size_v + d.gap;
  const patterns::SurfaceFrame on = patterns::SurfaceFrame::at(at.p, at.n);
  const patterns::Repeat row = patterns::repeat(on.v, pitch_v);
  float pitch_u = d.size_u + d.gap, shift = 0;
  const bool odd = (row.index & 1) != 0;
  if (d.bond == BrickBond::kRunning && odd) shift = 0.5f * pitch_u;
  if (d.bond == BrickBond::kEnglish && odd) {
    shift = 0.25f * pitch_u;
    pitch_u *= 0.5f;
  }
  // Worn edges: joints wander by a few millimetres, more where bricks are chipped.
  const Noise wear = fbm(at.p, 60.0f, 2, 0.6f, foot, d.seed + 1u);
  const float wander = d.gap * (0.05f + 0.12f * d.amount);
  Field u = on.field_u() + wear.field * wander;
  const Field v = on.field_v() - wear.field * (0.6f * wander);
  u.value += shift;
  const Field local_v{v.value - on.v + row.offset, v.gradient};  // keeps precision far out
  // The wandering that is no longer seen blurs joints.
  const float lost = wander * sqrtf(12.0f * wear.lost);
  const auto coverage = [&](float width, Field* joint_u) {
    const float w = sqrtf(width * width + lost * lost);
    Field across = patterns::unit_coverage(u, pitch_u, d.gap, w);
    if (d.bond != BrickBond::kStack) {  // several rows, shifted against each other
      const float t = smooth_step(0.6f, 1.6f, w / pitch_v);
      const float mean = d.bond == BrickBond::kRunning ? 1.0f - d.gap / pitch_u
                                                       : 1.0f - 1.5f * d.gap / (d.size_u + d.gap);
      across = across * (1.0f - t) + mean * t;
    }
    *joint_u = across;
    return across * patterns::unit_coverage(local_v, pitch_v, d.gap, w);
  };
  Field joint;
  const float brick = coverage(max(foot, 0.3f * d.bevel), &joint).value;
  const Field rounded = coverage(max(foot, 2.0f * d.bevel), &joint);
  // One brick's shade: between the colours, and some burnt dark.
  const uint32_t h = hash_cell(patterns::repeat(u.value, pitch_u).index, row.index,
                               static_cast<int>(d.bond), d.seed);
  const float left = patterns::detail_left(foot, d.size_v);
  const float shade = 0.5f + (hash_unit(h, 0) - 0.5f) * d.variation * left;
  const float burnt = hash_unit(h, 1) > 0.86f ? left : 0.0f;
  const float dark = 0.45f * d.variation * (burnt + 0.14f * (1.0f - left));
  const Noise grain = fbm(at.p, 240.0f, 2, 0.8f, foot, d.seed + 5u);
  const Noise bloom = fbm(at.p, 9.0f, 2, 0.6f, foot, d.seed + 8u);
  const Vec3f clay =
      lerp(d.color_a, d.color_b, clamp(shade, 0.0f, 1.0f)) *
      ((1.0f - dark) *
       max(1.0f + d.variation * (0.12f * grain.field.value + 0.14f * bloom.field.value), 0.0f));
  const Vec3f mortar = d.color_c * max(1.0f + 0.1f * grain.field.value, 0.0f);
  ProceduralSample s;
  s.base_color = lerp(mortar, clay, brick);
  s.roughness = lerp(d.gap_roughness, d.roughness, brick);
  s.relief = (rounded - 1.0f) * d.depth + grain.field * 0.0002f + wear.field * (0.0006f * d.amount);
  s.metallic = d.metallic;
  s.coat_weight = d.coat * brick;
  s.coat_roughness = d.coat_roughness;
  return s;
}

namespace masonry {

/// The hexagon (flat to flat = `pitch`, flats across u) around the place.
struct HexCell {
  int column, row;
  float u, v;   ///< from its centre [m]
  Field inner;  ///< distance to its border, inwards [m]
};
GLOAM_HD HexCell hexagon(const patterns::SurfaceFrame& on, float pitch) {
  // Centres form two rectangular grids of pitch x √3 pitch, one in the middles of the other.
  const float tall = 1.7320508f * pitch;
  const auto nearest = [&](float shift) {
    const patterns::Repeat a = patterns::repeat(on.u + shift * pitch, pitch),
                           b = patterns::repeat(on.v + shift * tall, tall);
    return HexCell{2 * a.index, 2 * b.index, a.offset - 0.5f * pitch, b.offset - 0.5f * tall, {}};
  };
  HexCell cell = nearest(0.0f), other = nearest(0.5f);
  other.column += 1;
  other.row += 1;
  if (sqr(other.u) + sqr(other.v) < sqr(cell.u) + sqr(cell.v)) cell = other;
  const float a = fabsf(cell.u), slant = 0.5f * a + 0.8660254f * fabsf(cell.v);
  const float su = cell.u < 0 ? -1.0f : 1.0f, sv = cell.v < 0 ? -1.0f : 1.0f;
  const Vec3f gradient =
      a > slant ? on.along_u * -su : on.along_u * (-0.5f * su) + on.along_v * (-0.8660254f * sv);
  cell.inner = {0.5f * pitch - max(a, slant), gradient};
  return cell;
}

}  // namespace masonry

/// Tiles of size_u x size_v [m], or hexagons of size_u between flats, with grout of `gap` between,
/// each of its own shade and laid slightly askew. color_a to color_b tile (differences between
/// tiles by `variation`), color_c grout; `coat` glaze, `bevel` of the edge, `amount` cloudiness
/// within.
GLOAM_HD ProceduralSample procedural_tiles(const ProceduralDescription& d,
                                           const ProceduralPoint& at) {
  const float foot = at.footprint, pitch_u = d.size_u + d.gap;
  const patterns::SurfaceFrame on = patterns::SurfaceFrame::at(at.p, at.n);
  const float sharp = max(foot, 0.3f * d.bevel), soft = max(foot, 2.0f * d.bevel);
  float tile, from_u, from_v, smaller;
  Field rounded;
  uint32_t h;
  if (d.tile == TileShape::kSquare) {
    const float pitch_v = d.size_v + d.gap;
    const auto coverage = [&](float width) {
      return patterns::unit_coverage(on.field_u(), pitch_u, d.gap, width) *
             patterns::unit_coverage(on.field_v(), pitch_v, d.gap, width);
    };
    const patterns::Repeat column = patterns::repeat(on.u, pitch_u),
                           row = patterns::repeat(on.v, pitch_v);
    h = hash_cell(column.index, row.index, 3, d.seed);
    from_u = column.offset - 0.5f * pitch_u;
    from_v = row.offset - 0.5f * pitch_v;
    smaller = min(pitch_u, pitch_v);
    tile = coverage(sharp).value;
    rounded = coverage(soft);
  } else {
    const masonry::HexCell cell = masonry::hexagon(on, pitch_u);
    h = hash_cell(cell.column, cell.row, 4, d.seed);
    from_u = cell.u;
    from_v = cell.v;
    smaller = pitch_u;
    const float mean = sqr(1.0f - d.gap / pitch_u);
    const float t = smooth_step(0.1f, 0.8f, foot / pitch_u);
    const auto coverage = [&](float width) {
      // Part of an interval across the nearest border that lies outside the joint.
      const float half = 0.5f * d.gap, lo = cell.inner.value - 0.5f * width, hi = lo + width;
      const float joint = clamp(hi, -half, half) - clamp(lo, -half, half);
      const auto in_joint = [&](float x) { return fabsf(x) < half ? 1.0f : 0.0f; };
      const Field here = compose(cell.inner, 1.0f - clamp(joint / width, 0.0f, 1.0f),
                                 (in_joint(lo) - in_joint(hi)) / width);
      return here * (1.0f - t) + mean * t;
    };
    tile = coverage(sharp).value;
    rounded = coverage(soft);
  }
  const float left = patterns::detail_left(foot, smaller);
  const uint32_t g = mix_bits(h + 1u);
  const Noise cloud = fbm(at.p + Vec3f{hash_unit(h, 0), hash_unit(h, 1), hash_unit(g, 0)} * 5.0f,
                          9.0f, 3, 0.6f, foot, d.seed + 1u);
  const float shade =
      0.5f + d.variation * left * (hash_unit(h, 0) - 0.5f) + 0.17f * d.amount * cloud.field.value;
  const Noise grime = fbm(at.p, 30.0f, 2, 0.6f, foot, d.seed + 4u);
  ProceduralSample s;
  s.base_color = lerp(d.color_c * max(1.0f + 0.12f * grime.field.value, 0.0f),
                      lerp(d.color_a, d.color_b, clamp(shade, 0.0f, 1.0f)), tile);
  s.roughness = lerp(d.gap_roughness, d.roughness, tile);
  s.metallic = d.metallic;
  s.coat_weight = d.coat * tile;
  s.coat_roughness = d.coat_roughness;
  // Askew by up to 1.5 mm/m; glaze undulates by tens of micrometres.
  const float tilt_u = (hash_unit(g, 0) - 0.5f) * 0.003f * left,
              tilt_v = (hash_unit(g, 1) - 0.5f) * 0.003f * left;
  const Field askew{from_u * tilt_u + from_v * tilt_v, on.along_u * tilt_u + on.along_v * tilt_v};
  const Noise wave = filtered_noise(at.p, {28.0f, 28.0f, 28.0f}, foot, d.seed + 9u);
  s.relief = (rounded - 1.0f) * d.depth + rounded * (askew + wave.field * 0.00003f);
  return s;
}

}  // namespace gloam
