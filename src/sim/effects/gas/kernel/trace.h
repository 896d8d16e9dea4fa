#pragma once
// Advection of velocity: paths of air through the grid (Stam 1999; second-order: MacCormack's
// correction, Selle et al. 2008), stable at any speed. Device-safe.

#include <cstdint>

#include "sim/effects/gas/kernel/interpolate.h"
#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

/// Longest path of a step, in voxels along an axis.
inline constexpr int kReach = 4;

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

/// Place half a step ago of the air at the centre of cell (i, j, k), where nothing is in the way.
GLOAM_HD Between half_way(const Carrier& v, int i, int j, int k) {
  const int c = v.shape.at(i, j, k);
  return place(v.shape, -1, float(i) - 0.5f * v.velocity.x[c], float(j) - 0.5f * v.velocity.y[c],
               float(k) - 0.5f * v.velocity.z[c]);
}

/// Displacement of that air in a step (Runge and Kutta, order 2).
GLOAM_HD Vec3f displacement(const Carrier& v, int i, int j, int k) {
  const Between b = half_way(v, i, j, k);
  return {interpolate(v.shape, v.velocity.x, b), interpolate(v.shape, v.velocity.y, b),
          interpolate(v.shape, v.velocity.z, b)};
}

/// True if walls may be in the way of air of this velocity and displacement: the longer of both
/// exceeds the distance that is `clear` around the cell.
GLOAM_HD bool comes_near_walls(Vec3f moved, Vec3f velocity, uint8_t clear) {
  return max(largest(moved), 0.5f * largest(velocity)) > float(clear);
}

/// Shortening of a path by walls above which velocity is carried in first order only [voxels].
inline constexpr float kMaxPathLoss = 0.25f;

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
  return max(lost, walk(v.shape, open, i, j, k, &forward)) <= kMaxPathLoss;
}

}  // namespace gloam::gas
