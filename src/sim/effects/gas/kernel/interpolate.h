#pragma once
// Trilinear interpolation of fields between the points of their lattices. Device-safe.

#include <bit>
#include <cstdint>

#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

/// A place between the points of a lattice.
struct Between {
  int c;          ///< the lowest corner
  float x, y, z;  ///< fractions of the higher ones
};

/// p: in steps of the lattice, which has one point more along `growing` (-1 = none). Places outside
/// go to its border.
GLOAM_HD Between place(const Shape& s, int growing, float px, float py, float pz) {
  const float hx = float(s.nx - 1 + (growing == 0)), hy = float(s.ny - 1 + (growing == 1)),
              hz = float(s.nz - 1 + (growing == 2));
  const float x = clamp(px, 0.0f, hx), y = clamp(py, 0.0f, hy), z = clamp(pz, 0.0f, hz);
  const int i = int(min(x, hx - 1.0f)), j = int(min(y, hy - 1.0f)), k = int(min(z, hz - 1.0f));
  Between out;
  out.c = s.at(i, j, k);
  out.x = x - float(i), out.y = y - float(j), out.z = z - float(k);
  return out;
}

/// The eight values around a place: x runs fastest.
struct Corners {
  float v0, v1, v2, v3, v4, v5, v6, v7;
};

/// Two values side by side, read at once: lanes that gather wait for each read.
struct Pair {
  float low, high;
};
GLOAM_HD Pair pair_at(const float* f, int c) {
#ifdef __CUDACC__
  return {f[c], f[c + 1]};
#else
  using Bits [[gnu::may_alias, gnu::aligned(4)]] = uint64_t;
  const uint64_t bits = *reinterpret_cast<const Bits*>(f + c);
  return {std::bit_cast<float>(uint32_t(bits)), std::bit_cast<float>(uint32_t(bits >> 32))};
#endif
}

GLOAM_HD Corners corners(const Shape& s, const float* f, int c) {
  const float *f2 = f + s.sy, *f4 = f + s.sz, *f6 = f4 + s.sy;
  const Pair a = pair_at(f, c), b = pair_at(f2, c), d = pair_at(f4, c), e = pair_at(f6, c);
  return {a.low, a.high, b.low, b.high, d.low, d.high, e.low, e.high};
}

GLOAM_HD float interpolate(const Corners& v, const Between& b) {
  const float a00 = v.v0 + b.x * (v.v1 - v.v0), a10 = v.v2 + b.x * (v.v3 - v.v2);
  const float a01 = v.v4 + b.x * (v.v5 - v.v4), a11 = v.v6 + b.x * (v.v7 - v.v6);
  const float a0 = a00 + b.y * (a10 - a00), a1 = a01 + b.y * (a11 - a01);
  return a0 + b.z * (a1 - a0);
}

GLOAM_HD float interpolate(const Shape& s, const float* f, const Between& b) {
  return interpolate(corners(s, f, b.c), b);
}

}  // namespace gloam::gas
