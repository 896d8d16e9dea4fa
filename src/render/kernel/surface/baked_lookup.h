#pragma once
// Look-ups of baked procedural materials. Device-safe.

#include "render/kernel/procedural/pattern.h"
#include "render/kernel/surface/baked_view.h"
#include "render/kernel/surface/texture.h"

namespace gloam {

namespace baking {

/// Direction in which a surface is seen: 2 axis, + 1 where it faces against the axis.
GLOAM_HD int face_of(Vec3f n) {
  const float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
  if (x > y && x > z) return n.x < 0 ? 1 : 0;
  if (y > z) return n.y < 0 ? 3 : 2;
  return n.z < 0 ? 5 : 4;
}
inline constexpr int kUp = 4;

/// A place along the two axes of a face's tiles and across them.
GLOAM_HD Vec3f along_face(Vec3f p, int face) {
  if (face < 2) return {p.y, p.z, p.x};
  return face < 4 ? Vec3f{p.x, p.z, p.y} : p;
}
/// The inverse of along_face().
GLOAM_HD Vec3f from_face(Vec3f q, int face) {
  if (face < 2) return {q.z, q.x, q.y};
  return face < 4 ? Vec3f{q.x, q.z, q.y} : q;
}

/// Key of the tile of `face` in the cube (i, j, k), counted along_face().
GLOAM_HD uint64_t tile_key(uint32_t table, int face, uint32_t i, uint32_t j, uint32_t k) {
  uint64_t key = table * 8u + static_cast<uint32_t>(face);
  key = key << kCubesLog2 | k;
  key = key << kCubesLog2 | j;
  return key << kCubesLog2 | i;
}
GLOAM_HD uint32_t slot_of(uint64_t key, uint32_t slots) {
  return mix_bits(static_cast<uint32_t>(key) ^ mix_bits(static_cast<uint32_t>(key >> 32))) &
         (slots - 1);
}
/// Number of the cube that the place x [cubes] lies in.
GLOAM_HD uint32_t cube_of(float x) {
  constexpr float kLast = static_cast<float>((1u << kCubesLog2) - 1u);
  return static_cast<uint32_t>(clamp(floorf(x), 0.0f, kLast));
}

GLOAM_HD const BakedTexel* find_tile(const BakedView& baked, uint64_t key) {
  const uint32_t last = baked.slots.size - 1;
  for (uint32_t at = slot_of(key, baked.slots.size);; at = (at + 1) & last) {
    const BakedSlot& slot = baked.slots[at];
    if (slot.key == key) return baked.texels.data + slot.first;
    if (slot.key == BakedSlot::kEmpty) return nullptr;
  }
}

inline constexpr float kSteepest = 4.0f;  ///< slope that a texel can hold [m/m]
GLOAM_HD float slope_from(int16_t x) {
  const float t = static_cast<float>(x) * (1.0f / 32767.0f);
  return kSteepest * t * fabsf(t);
}

/// Weighted sum of texels.
struct TexelSum {
  Vec3f color;
  float roughness = 0, metallic = 0, coat_weight = 0, fuzz = 0, mask = 0, slope_u = 0, slope_v = 0;

  GLOAM_HD void add(const BakedTexel& t, float weight) {
    const float wide = weight * (1.0f / 65535.0f), narrow = weight * (1.0f / 255.0f);
    color +=
        Vec3f{static_cast<float>(t.red), static_cast<float>(t.green), static_cast<float>(t.blue)} *
        wide;
    roughness += static_cast<float>(t.roughness) * wide;
    metallic += static_cast<float>(t.metallic) * narrow;
    coat_weight += static_cast<float>(t.coat_weight) * narrow;
    fuzz += static_cast<float>(t.fuzz) * narrow;
    mask += static_cast<float>(t.mask) * narrow;
    slope_u += slope_from(t.slope_u) * weight;
    slope_v += slope_from(t.slope_v) * weight;
  }
  /// The bilinear value at (u, v) in the tile, 0 to 1 along its edges.
  GLOAM_HD void add_level(const BakedTexel* tile, int level, float u, float v, float weight) {
    const int n = kSide >> level;
    const float x = u * static_cast<float>(n), y = v * static_cast<float>(n);
    int i = static_cast<int>(x), j = static_cast<int>(y);
    i = i < n ? i : n - 1;
    j = j < n ? j : n - 1;
    const float wx = x - static_cast<float>(i), wy = y - static_cast<float>(j);
    const BakedTexel* t = tile + level_begin(level) + static_cast<uint32_t>(j * (n + 1) + i);
    add(t[0], (1 - wx) * (1 - wy) * weight);
    add(t[1], wx * (1 - wy) * weight);
    add(t[n + 1], (1 - wx) * wy * weight);
    add(t[n + 2], wx * wy * weight);
  }
};

/// Level whose texels suit a footprint [texels of the finest level].
GLOAM_HD float lod_of(float footprint) {
  // Samples d apart, each a mean over kBakedFootprint d, blur as much by their interpolation as a
  // mean over the footprint does when d is this part of it: d²/6 + (kBakedFootprint d)²/12 =
  // footprint²/12.
  constexpr float kDistance = 0.615f;
  const float texels = kDistance * footprint;
  return texels > 1 ? texturing::log2_of(texels) : 0.0f;
}

/// Where a footprint is looked up.
struct BakedLevel {
  int table, level;  ///< the finer of two levels
  float blend;       ///< with the coarser one
};
GLOAM_HD BakedLevel level_of(const BakedPattern& pattern, float footprint) {
  const float lod = lod_of(footprint * pattern.per_metre);
  int table = static_cast<int>(lod * (1.0f / kSideLog2));
  table = table < pattern.tables ? table : pattern.tables - 1;
  const float rest = min(lod - static_cast<float>(kSideLog2 * table), kLevels - 1.0f);
  int level = static_cast<int>(rest);
  level = level < kLevels - 1 ? level : kLevels - 2;
  return {table, level, rest - static_cast<float>(level)};
}

/// The value of a map that repeats at (u, v) [repeats].
GLOAM_HD void add_map(const BakedTexel* map, int side, float u, float v, float weight,
                      TexelSum* sum) {
  const float x = (u - floorf(u)) * static_cast<float>(side),
              y = (v - floorf(v)) * static_cast<float>(side);
  const int last = side - 1;
  const int i = static_cast<int>(x) & last, j = static_cast<int>(y) & last;
  const int i1 = (i + 1) & last, j1 = (j + 1) & last;
  const float wx = x - floorf(x), wy = y - floorf(y);
  sum->add(map[j * side + i], (1 - wx) * (1 - wy) * weight);
  sum->add(map[j * side + i1], wx * (1 - wy) * weight);
  sum->add(map[j1 * side + i], (1 - wx) * wy * weight);
  sum->add(map[j1 * side + i1], wx * wy * weight);
}

/// Adds the detail at a place along_face() [m], as much of it as a footprint leaves.
GLOAM_HD void add_detail(const BakedView& baked, const BakedDetail& detail, int face, Vec3f q,
                         float footprint, TexelSum* sum) {
  const float lod = lod_of(footprint * detail.texels_per_metre);
  const int base = static_cast<int>(lod);
  if (base >= detail.levels) return;
  const BakedTexel* map = baked.texels.data + detail.first[face >> 1];
  int side = detail.side;
  for (int i = 0; i < base; ++i, side >>= 1) map += side * side;
  const float u = q.x * detail.repeats.x, v = q.y * detail.repeats.y;
  const float blend = lod - static_cast<float>(base);
  TexelSum part;
  float weight = 1.0f - blend;
  add_map(map, side, u, v, weight, &part);
  if (base + 1 < detail.levels) {
    weight = 1.0f;
    add_map(map + side * side, side >> 1, u, v, blend, &part);
  }
  const auto wide = [&](float x) { return x * (65535.0f / 32767.0f) - weight; };
  const auto narrow = [&](float x) { return x * (255.0f / 127.0f) - weight; };
  sum->color += Vec3f{wide(part.color.x), wide(part.color.y), wide(part.color.z)};
  sum->roughness += wide(part.roughness);
  sum->metallic += narrow(part.metallic);
  sum->coat_weight += narrow(part.coat_weight);
  sum->fuzz += narrow(part.fuzz);
  sum->mask += narrow(part.mask);
  sum->slope_u += part.slope_u;
  sum->slope_v += part.slope_v;
}

}  // namespace baking

/// The sample of row `row` of the view's patterns at a place on its surface.
GLOAM_HD ProceduralSample baked_sample(const BakedView& baked, uint32_t row,
                                       const ProceduralPoint& at) {
  const BakedPattern& pattern = baked.patterns[row];
  const baking::BakedLevel where = baking::level_of(pattern, at.footprint);
  const int face = pattern.is_sheet ? baking::kUp : baking::face_of(at.n);
  // Texels per cube and the next table's scale are powers of two: all products are exact.
  float per_metre = pattern.per_metre * (1.0f / baking::kSide);
  for (int i = 0; i < where.table; ++i) per_metre *= 1.0f / baking::kSide;
  const Vec3f q = baking::along_face((at.p - pattern.low) * per_metre, face);
  const uint32_t i = baking::cube_of(q.x), j = baking::cube_of(q.y);
  const uint32_t k = pattern.is_sheet ? 0u : baking::cube_of(q.z);
  const uint64_t key =
      baking::tile_key(pattern.first_table + static_cast<uint32_t>(where.table), face, i, j, k);
  const BakedTexel* tile = baking::find_tile(baked, key);
  baking::TexelSum sum;
  if (tile == nullptr) {
    sum.add(pattern.mean, 1.0f);
  } else {
    const float u = clamp(q.x - static_cast<float>(i), 0.0f, 1.0f);
    const float v = clamp(q.y - static_cast<float>(j), 0.0f, 1.0f);
    sum.add_level(tile, where.level, u, v, 1.0f - where.blend);
    if (where.blend > 0) sum.add_level(tile, where.level + 1, u, v, where.blend);
  }
  if (pattern.detail.levels > 0) {
    baking::add_detail(baked, pattern.detail, face, baking::along_face(at.p, face), at.footprint,
                       &sum);
  }
  const auto unit = [](float x) { return clamp(x, 0.0f, 1.0f); };
  ProceduralSample s;
  s.base_color = {unit(sum.color.x), unit(sum.color.y), unit(sum.color.z)};
  s.roughness = unit(sum.roughness);
  s.metallic = unit(sum.metallic);
  s.coat_weight = unit(sum.coat_weight);
  s.coat_roughness = pattern.coat_roughness;
  s.fuzz = unit(sum.fuzz);
  s.mask = unit(sum.mask);
  s.relief.gradient = baking::from_face({sum.slope_u, sum.slope_v, 0}, face);
  return s;
}

}  // namespace gloam
