#pragma once
// Where air came from: paths through the grid, and fields between its points. Velocity is carried
// by them (Stam 1999; second-order: MacCormack's correction, Selle et al. 2008), which no speed
// makes unstable. Device-safe.

#include <bit>
#include <cstdint>

#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

/// Longest path of a step, in voxels along an axis.
inline constexpr int kReach = 4;

/// A place between the points of a lattice.
struct Between {
  int c;          ///< the lowest corner
  float x, y, z;  ///< shares of the higher ones
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

/// Along one axis of a walk. o: from the cell's centre; the air slides along what is closed, half a
/// voxel before it, where nothing from beyond is mixed in.
/// Returns by how much that shortened the way [voxels].
GLOAM_HD float walk_axis(const float* open, int stride, int n, float step, int* i, int* c,
                         float* o) {
  *o += step;
  float lost = 0;
  const int face = *c + (*o > 0.0f ? stride : 0);
  if (open[face] == 0.0f) {
    lost = max(*o, -*o);
    *o = 0.0f;
  }
  if (*o > 0.5f && *i < n) *i += 1, *c += stride, *o -= 1.0f;
  if (*o < -0.5f && *i >= 0) *i -= 1, *c -= stride, *o += 1.0f;
  return lost;
}

GLOAM_HD float largest(Vec3f v) { return max(max(max(v.x, -v.x), max(v.y, -v.y)), max(v.z, -v.z)); }

/// From the centre of cell (i, j, k) by d voxels, past what is closed. Returns by how much the
/// way was shortened, axes added up [voxels].
GLOAM_HD float walk(const Shape& s, const Faces<const float>& open, int i, int j, int k, Vec3f* d) {
  const int steps = int(largest(*d) * 2.0f) + 1;
  const Vec3f step = *d * (1.0f / float(steps));
  int a = i, b = j, e = k, c = s.at(i, j, k);
  Vec3f o;
  float lost = 0;
  for (int n = 0; n < steps; ++n) {
    // Outside of the box there are no faces, and nothing in the way.
    if (a < 0 || a >= s.nx || b < 0 || b >= s.ny || e < 0 || e >= s.nz) {
      o += step * float(steps - n);
      break;
    }
    lost += walk_axis(open.x, 1, s.nx, step.x, &a, &c, &o.x);
    if (a < 0 || a >= s.nx) continue;
    lost += walk_axis(open.y, s.sy, s.ny, step.y, &b, &c, &o.y);
    if (b < 0 || b >= s.ny) continue;
    lost += walk_axis(open.z, s.sz, s.nz, step.z, &e, &c, &o.z);
  }
  *d = {float(a - i) + o.x, float(b - j) + o.y, float(e - k) + o.z};
  return lost;
}

/// Velocities of cells' centres, in voxels per step.
struct Carrier {
  Shape shape;
  Faces<const float> velocity;
};

/// Velocity of the centre of the cell at c times 2 `half`, each component at most `limit`.
GLOAM_HD Vec3f carrier_velocity(const Shape& s, const Faces<const float>& u, int c, float half,
                                float limit) {
  const Vec3f v = centre_twice(s, u, c);
  return {clamp(half * v.x, -limit, limit), clamp(half * v.y, -limit, limit),
          clamp(half * v.z, -limit, limit)};
}

/// Where the air of the centre of cell (i, j, k) was half a step ago, where nothing is in the way.
GLOAM_HD Between half_way(const Carrier& v, int i, int j, int k) {
  const int c = v.shape.at(i, j, k);
  return place(v.shape, -1, float(i) - 0.5f * v.velocity.x[c], float(j) - 0.5f * v.velocity.y[c],
               float(k) - 0.5f * v.velocity.z[c]);
}

/// By how much that air moved in a step (Runge and Kutta, order 2).
GLOAM_HD Vec3f displacement(const Carrier& v, int i, int j, int k) {
  const Between b = half_way(v, i, j, k);
  return {interpolate(v.shape, v.velocity.x, b), interpolate(v.shape, v.velocity.y, b),
          interpolate(v.shape, v.velocity.z, b)};
}

/// Whether walls may be in the way of air of this velocity that moved so: where it is longer than
/// what is `clear` around the cell.
GLOAM_HD bool comes_near_walls(Vec3f moved, Vec3f velocity, uint8_t clear) {
  return max(largest(moved), 0.5f * largest(velocity)) > float(clear);
}

/// Where walls shorten ways by more, velocity is carried in first order only [voxels].
inline constexpr float kTrustedLoss = 0.25f;

/// The same near walls. False if what was in the way matters.
GLOAM_HD bool displacement_near_walls(const Carrier& v, const Faces<const float>& open, int i,
                                      int j, int k, Vec3f* moved) {
  const int c = v.shape.at(i, j, k);
  const Vec3f here{v.velocity.x[c], v.velocity.y[c], v.velocity.z[c]};
  Vec3f half = here * -0.5f;
  walk(v.shape, open, i, j, k, &half);
  const Between b = place(v.shape, -1, float(i) + half.x, float(j) + half.y, float(k) + half.z);
  Vec3f whole = -Vec3f{interpolate(v.shape, v.velocity.x, b), interpolate(v.shape, v.velocity.y, b),
                       interpolate(v.shape, v.velocity.z, b)};
  Vec3f forward = here * 2.0f + whole;
  const float lost = walk(v.shape, open, i, j, k, &whole);
  *moved = -whole;
  return max(lost, walk(v.shape, open, i, j, k, &forward)) <= kTrustedLoss;
}

}  // namespace gloam::gas
