#pragma once
// Indirect light kept in the world, for one camera: cells of a hash grid, each a cube of space and
// a facing, hold the light that surfaces there get from other surfaces and from the sky, or that
// media there scatter. Cells grow with the distance from the camera. Device-safe.

#include "render/kernel/interactive/interactive_constants.h"
#include "render/kernel/math/ray.h"

namespace gloam {

/// Light on the surfaces of a cell, as the luminance of even surroundings [cd/m²].
struct CellLight {
  Vec3f all;   ///< from everywhere
  Vec3f near;  ///< of that, from surfaces less than the cell's edge away; in air, from lamps
  float near_fraction = 0;  ///< of directions that meet such surfaces

  /// Light before a cell's first rays: `all` is a guess, and larger cells know better.
  static CellLight unknown(Vec3f guess) { return {guess, {}, -1}; }
  GLOAM_HD bool is_known() const { return near_fraction >= 0; }
};

GLOAM_HD CellLight lerp(const CellLight& a, const CellLight& b, float t) {
  return {lerp(a.all, b.all, t), lerp(a.near, b.near, t),
          lerp(a.near_fraction, b.near_fraction, t)};
}

/// Light at a place in the cell from which the fraction `near` of directions meet what is near: in
/// corners and under things it differs from the cell's mean.
GLOAM_HD Vec3f light_at(const CellLight& cell, float near) {
  if (!cell.is_known()) return cell.all;
  const Vec3f far =
      (cell.all - cell.near) / max(1.0f - cell.near_fraction, interactive::kMinFarFraction);
  const Vec3f close =
      (cell.near + far * (interactive::kNearPriorFraction * interactive::kNearPriorLight)) /
      (cell.near_fraction + interactive::kNearPriorFraction);
  return lerp(far, close, near);
}

/// Start of the first ray of a cell of air.
struct AirHome {
  Vec3f p;
  bool sees_all = true;  ///< that may ask the cell; else light differs on both sides of a wall
};

/// The cells that are there, and their size.
struct CellGrid {
  DeviceSpan<const uint64_t> keys;   ///< open addressing, size a power of two; 0 = free
  DeviceSpan<const uint32_t> cells;  ///< row of each key
  Vec3f eye;
  float edge_per_metre = 0.03f;  ///< edge of a cell over its distance from the eye
};

struct IrradianceCacheView : CellGrid {
  DeviceSpan<const CellLight> light;
  DeviceSpan<const AirHome> homes;  ///< of cells of air, in the rows of `light`
  Vec3f mean;                       ///< of all cells, for those that are not there yet
  bool lamps_move = false;          ///< then what they give the air is not what it was
};

namespace caches {

/// First place of a key in a table of `size` (a power of two).
GLOAM_HD uint32_t slot_of(uint64_t key, uint32_t size) {
  return static_cast<uint32_t>((key * 0x9E3779B97F4A7C15ull) >> 32) & (size - 1u);
}

/// Bits that the keys of one region share: four cells wide, of all facings.
inline constexpr uint64_t kRegion =
    ~(uint64_t{7} | uint64_t{3} << 9 | uint64_t{3} << 27 | uint64_t{3} << 45);
/// Sixteen cells wide, of all facings; and the facing of a cell.
inline constexpr uint64_t kWideRegion =
    ~(uint64_t{7} | uint64_t{15} << 9 | uint64_t{15} << 27 | uint64_t{15} << 45);
inline constexpr uint64_t kFacing = 7;

/// The part of a key that tells the place along an axis.
struct PlaceBits {
  int shift;
  uint64_t mask;
};
GLOAM_HD PlaceBits place_bits(int axis) {
  const int shift = 9 + 18 * axis;
  return {shift, uint64_t{axis < 2 ? 0x3FFFFu : 0xFFFFu} << shift};
}

/// Key of the cell next along an axis, of the same facing.
GLOAM_HD uint64_t beside(uint64_t key, int axis, bool up) {
  const auto [shift, mask] = place_bits(axis);
  const uint64_t one = uint64_t{1} << shift;
  return (key & ~mask) | ((up ? key + one : key - one) & mask);
}

/// Side of the cell of a key: kOutsideCell, kInsideCell, kAirCell or kHiddenAirCell.
GLOAM_HD uint32_t side_of(uint64_t key) { return static_cast<uint32_t>(key >> 61 & 3u); }
GLOAM_HD bool is_air(uint64_t key) { return key >> 62 & 1u; }

/// Key of the cell for air that something hides from the home of the cell of air `key`.
GLOAM_HD uint64_t hidden(uint64_t key) { return key | uint64_t{1} << 61; }

/// Edge of the cell of a key [m].
GLOAM_HD float edge_of(uint64_t key) {
  // Exponents from 2^-32 on are told by their last six bits.
  const auto low = static_cast<uint32_t>(key >> 3 & 63u);
  return from_bits(((low >= 32u ? 64u : 128u) + low) << 23);
}

/// Middle of the cell of a key [m].
GLOAM_HD Vec3f middle_of(uint64_t key) {
  const auto along = [&](int axis) {
    const auto [shift, mask] = place_bits(axis);
    const int above = axis < 2 ? 46 : 48;  // its highest bit is that of its sign
    return static_cast<float>(static_cast<int64_t>((key & mask) >> shift << above) >> above) + 0.5f;
  };
  return Vec3f{along(0), along(1), along(2)} * edge_of(key);
}

}  // namespace caches

/// Side of a cell: surfaces seen from outside or inside, air, or air behind a wall. Inner sides of
/// panes lie where their outer sides do, and air where both do. A cell of air faces the direction
/// of the ray, against which it scatters light; where a wall passes through it, air behind the wall
/// has a cell of its own.
inline constexpr uint32_t kOutsideCell = 0, kInsideCell = 1, kAirCell = 2, kHiddenAirCell = 3;

/// A cell before its numbers are packed.
template <class F>
struct CacheCellOf {
  Vec3Of<F> place;  ///< whole numbers of edges
  UintOf<F> exponent, facing, side;
  F edge;  ///< [m]
};

/// The cells for surfaces at p with the normals n. `jitter` in [0, 1)³ blurs the borders of cells,
/// facings and sizes; `coarser`: doublings of the edge.
template <class F>
GLOAM_HD CacheCellOf<F> cache_cell(const CellGrid& grid, Vec3Of<F> p, Vec3Of<F> n, UintOf<F> side,
                                   Vec3Of<F> jitter, uint32_t coarser) {
  const Vec3Of<F> from_eye = p - in_all_lanes<F>(grid.eye);
  // The greatest power of two up to edge (1 + jitter), so that sizes blend.
  const F wanted =
      max(square_root(dot(from_eye, from_eye)) * grid.edge_per_metre, F(interactive::kLeastEdge)) *
      (1.0f + jitter.z);
  CacheCellOf<F> cell;
  cell.exponent = (to_bits(wanted) >> 23) + coarser;
  cell.edge = from_bits(cell.exponent << 23);
  const F per_edge = 1.0f / cell.edge;
  const Vec3Of<F> shift{jitter.x - 0.5f, jitter.y - 0.5f, jitter.z - 0.5f};
  const Vec3Of<F> bent = n + shift * F(interactive::kFacingBlur);
  const Vec3Of<F> a{magnitude(bent.x), magnitude(bent.y), magnitude(bent.z)};
  const MaskOf<F> up = (a.z >= a.x) & (a.z >= a.y), along_y = (!up) & (a.y >= a.x);
  const F most = select(up, bent.z, select(along_y, bent.y, bent.x));
  const auto two = [](MaskOf<F> m, uint32_t yes) {
    return select(m, UintOf<F>(yes), UintOf<F>(0u));
  };
  cell.facing = two(up, 4) + two(along_y, 2) + two(most < 0.0f, 1);
  cell.side = side;
  const FrameOf<F> frame = FrameOf<F>::from_z(n);
  // Off the surface, as faces of rooms and boxes like to lie on the borders of cells.
  const Vec3Of<F> at =
      (p +
       (frame.x * shift.x + frame.y * shift.y + n * F(interactive::kSurfaceOffset)) * cell.edge) *
      per_edge;
  cell.place = {floor_of(at.x), floor_of(at.y), floor_of(at.z)};
  return cell;
}

/// The key of one cell; 0 = none.
template <class F>
GLOAM_HD uint64_t cache_key(const CacheCellOf<F>& cell, int i) {
  uint64_t key = lane(cell.facing, i) | uint64_t{lane(cell.exponent, i) & 63u} << 3 |
                 uint64_t{lane(cell.side, i)} << 61 | uint64_t{1} << 63;
  const Vec3f place = lane(cell.place, i);
  for (int k = 0; k < 3; ++k) {
    if (!(fabsf(place[k]) < 1e6f)) return 0;
    const auto [shift, mask] = caches::place_bits(k);
    key |= (static_cast<uint64_t>(static_cast<int64_t>(place[k])) << shift) & mask;
  }
  return key;
}
GLOAM_HD uint64_t cache_key(const CellGrid& grid, Vec3f p, Vec3f n, uint32_t side, Vec3f jitter,
                            uint32_t coarser) {
  return cache_key(cache_cell<float>(grid, p, n, side, jitter, coarser), 0);
}

namespace caches {

/// Whether nothing is between a and b.
template <class Tracer>
GLOAM_HD bool is_clear(const Tracer& tracer, Vec3f a, Vec3f b) {
  Ray ray;
  ray.o = a;
  const Vec3f to = b - a;
  ray.tmax = length(to);
  if (!(ray.tmax > 0)) return true;
  ray.d = to / ray.tmax;
  return !tracer.occluded(ray, true);
}
/// Whether p_W may ask the cell.
template <class Tracer>
GLOAM_HD bool is_seen(const Tracer& tracer, const AirHome& home, Vec3f p_W) {
  return home.sees_all || is_clear(tracer, home.p, p_W);
}

}  // namespace caches

/// Row of the key's cell, or -1; of one that is not known, too.
GLOAM_HD int find_cell(const CellGrid& grid, uint64_t key) {
  if (key == 0 || grid.keys.empty()) return -1;
  for (uint32_t slot = caches::slot_of(key, grid.keys.size);;
       slot = (slot + 1) & (grid.keys.size - 1u)) {
    if (grid.keys[slot] == key) return static_cast<int>(grid.cells[slot]);
    if (grid.keys[slot] == 0) return -1;
  }
}

/// Row of the key's cell if its light is known, or -1.
GLOAM_HD int find_known_cell(const IrradianceCacheView& cache, uint64_t key) {
  const int row = find_cell(cache, key);
  return row >= 0 && cache.light[static_cast<uint32_t>(row)].is_known() ? row : -1;
}

}  // namespace gloam
