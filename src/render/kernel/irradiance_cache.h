#pragma once
// Indirect light kept in the world, for one camera: cells of a hash grid, each a cube of space and
// a facing, hold the light that surfaces there get from other surfaces and from the sky. Cells grow
// with the distance from the camera. Device-safe.

#include "render/kernel/ray.h"

namespace gloam {

struct IrradianceCacheView {
  DeviceSpan<const uint64_t> keys;   ///< open addressing, size a power of two; 0 = free
  DeviceSpan<const uint32_t> cells;  ///< row of `light` of each key
  /// Luminance of even surroundings that would light the cell's surfaces as strongly [cd/m²].
  DeviceSpan<const Vec3f> light;
  Vec3f eye;
  float edge_per_metre = 0.03f;  ///< edge of a cell over its distance from the eye
};

namespace caches {

GLOAM_HD float bits_to_float(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}
GLOAM_HD uint32_t float_to_bits(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

/// First place of a key in a table of `size` (a power of two).
GLOAM_HD uint32_t slot_of(uint64_t key, uint32_t size) {
  return static_cast<uint32_t>((key * 0x9E3779B97F4A7C15ull) >> 32) & (size - 1u);
}

}  // namespace caches

/// The cell for a surface at p with the normal n; 0 = none. `jitter` in [0, 1)³ blurs the borders
/// of cells, facings and sizes; `coarser`: doublings of the edge.
GLOAM_HD uint64_t cache_key(const IrradianceCacheView& cache, Vec3f p, Vec3f n, Vec3f jitter,
                            int coarser) {
  // The greatest power of two up to edge (1 + jitter), so that sizes blend.
  const float wanted = max(length(p - cache.eye) * cache.edge_per_metre, 0.01f) * (1.0f + jitter.z);
  const uint32_t exponent = (caches::float_to_bits(wanted) >> 23) + static_cast<uint32_t>(coarser);
  const float edge = caches::bits_to_float(exponent << 23), per_edge = 1.0f / edge;
  const Vec3f bent = n + Vec3f{jitter.x - 0.5f, jitter.y - 0.5f, jitter.z - 0.5f} * 0.3f;
  const Vec3f a{fabsf(bent.x), fabsf(bent.y), fabsf(bent.z)};
  const int axis = a.z >= a.x && a.z >= a.y ? 2 : (a.y >= a.x ? 1 : 0);
  const uint64_t facing = static_cast<uint64_t>(2 * axis + (bent[axis] < 0 ? 1 : 0));
  const Frame frame = Frame::from_z(n);
  // Off the surface, as faces of rooms and boxes like to lie on the borders of cells.
  const Vec3f at =
      p + (frame.x * (jitter.x - 0.5f) + frame.y * (jitter.y - 0.5f) + n * 0.3f) * edge;
  uint64_t key = facing | static_cast<uint64_t>(exponent & 63u) << 3 | uint64_t{1} << 63;
  for (int k = 0; k < 3; ++k) {
    const float x = floorf(at[k] * per_edge);
    if (!(fabsf(x) < 1e6f)) return 0;
    key |= (static_cast<uint64_t>(static_cast<int64_t>(x)) & 0x3FFFFu) << (9 + 18 * k);
  }
  return key;
}

/// Row of the key's cell, or -1.
GLOAM_HD int find_cell(const IrradianceCacheView& cache, uint64_t key) {
  if (key == 0 || cache.keys.empty()) return -1;
  for (uint32_t slot = caches::slot_of(key, cache.keys.size);;
       slot = (slot + 1) & (cache.keys.size - 1u)) {
    if (cache.keys[slot] == key) return static_cast<int>(cache.cells[slot]);
    if (cache.keys[slot] == 0) return -1;
  }
}

}  // namespace gloam
