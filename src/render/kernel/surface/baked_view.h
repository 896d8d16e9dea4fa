#pragma once
// Procedural materials as textures on the surfaces that wear them, as the kernel reads them:
// render/scene/patterns bakes them, baked_lookup.h looks them up. Device-safe.
//
// The frame G of a shape is divided into cubes. A surface inside a cube is projected along the axis
// that its normal is nearest to, as patterns::SurfaceFrame does, onto one of six tiles of that
// cube, one for each direction that a surface faces. A tile holds samples on a grid over the cube's
// side and on coarser grids over the same side, for wider footprints. A surface has several tables:
// the texels and cubes of each are kSide times as wide as those of the one before. Only cubes that
// the surface touches have tiles; a hash table finds them.

#include "base/vec.h"

namespace gloam {

namespace baking {

inline constexpr int kSideLog2 = 3;
inline constexpr int kSide = 1 << kSideLog2;  ///< intervals along a tile's edge, finest level
inline constexpr int kLevels = kSideLog2 + 1;

/// Samples of a tile before level `level`, whose edge has kSide >> level intervals.
GLOAM_HD uint32_t level_begin(int level) {
  uint32_t begin = 0;
  for (int i = 0; i < level; ++i) {
    const auto edge = static_cast<uint32_t>(kSide >> i) + 1u;
    begin += edge * edge;
  }
  return begin;
}
inline constexpr uint32_t kTileTexels = 9 * 9 + 5 * 5 + 3 * 3 + 2 * 2;

inline constexpr uint32_t kCubesLog2 = 13;  ///< of the number of a table's cubes along an axis
inline constexpr uint32_t kTablesLog2 = 20;

}  // namespace baking

/// A sample of a procedural material: ProceduralSample in 16 bytes.
struct BakedTexel {
  uint16_t red = 0, green = 0, blue = 0, roughness = 0;  ///< 65535 = 1
  /// Slope of the relief along the two axes of the tile: 4 (x / 32767)², with the sign of x [m/m].
  int16_t slope_u = 0, slope_v = 0;
  uint8_t metallic = 0, coat_weight = 0, fuzz = 0, mask = 0;  ///< 255 = 1
};
static_assert(sizeof(BakedTexel) == 16);

/// Repeating map of the detail that is finer than a surface's texels: the sharp pattern at some
/// other place minus the pattern as the surface's texels show it there. Its texels store
/// differences from -1 to 1 as 0 to twice 32767 or 127.
struct BakedDetail {
  uint32_t first[3] = {};      ///< row of the first texel of the map for each axis
  int side = 0;                ///< texels along an edge, a power of two
  int levels = 0;              ///< each of half as many; 0 = there is no detail
  Vec2f repeats;               ///< of the map per metre along the two axes
  float texels_per_metre = 0;  ///< of the finest level
};

/// A procedural material on one surface.
struct BakedPattern {
  Vec3f low;                 ///< where the cubes begin, in G [m]
  float per_metre = 0;       ///< texels of the first table per metre
  uint32_t first_table = 0;  ///< number of its first table in keys
  int tables = 0;
  bool is_sheet = false;     ///< may rise and sink: one layer of cubes, all of it faces +z
  float coat_roughness = 0;  ///< everywhere
  BakedDetail detail;
  BakedTexel mean;  ///< of the whole pattern, where there is no tile
};

struct BakedSlot {
  static constexpr uint64_t kEmpty = ~0ull;
  uint64_t key = kEmpty;  ///< baked_key() of a tile
  uint64_t first = 0;     ///< row of its first sample
};

/// Without patterns, procedural materials are evaluated by their formulas.
struct BakedView {
  DeviceSpan<const BakedPattern> patterns;
  DeviceSpan<const BakedSlot> slots;  ///< open addressing; their number is a power of two
  DeviceSpan<const BakedTexel> texels;
};

}  // namespace gloam
