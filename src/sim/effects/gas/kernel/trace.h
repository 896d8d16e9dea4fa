#pragma once
// Where air came from: paths through the grid, and fields between its points. Velocity is carried
// by them (Stam 1999; second-order: MacCormack's correction, Selle et al. 2008), which no speed
// makes unstable. Device-safe.

#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

/// Longest path of a step, in voxels along an axis.
inline constexpr int kReach = 4;

/// A place between the points of a lattice.
struct Between {
  int c;           ///< the lowest corner
  float x, y, z;   ///< shares of the higher ones
  float outside;   ///< how far the place was outside of the lattice, in voxels
};

/// p: in steps of the lattice; it has nx + grow.x … points. Places outside go to its border.
GLOAM_HD Between place(const Shape& s, int growing, float px, float py, float pz) {
  const float hx = float(s.nx - 1 + (growing == 0)), hy = float(s.ny - 1 + (growing == 1)),
              hz = float(s.nz - 1 + (growing == 2));
  const float x = clamp(px, 0.0f, hx), y = clamp(py, 0.0f, hy), z = clamp(pz, 0.0f, hz);
  const int i = int(min(x, hx - 1.0f)), j = int(min(y, hy - 1.0f)), k = int(min(z, hz - 1.0f));
  Between out;
  out.c = s.at(i, j, k);
  out.x = x - float(i), out.y = y - float(j), out.z = z - float(k);
  const float ox = px - x, oy = py - y, oz = pz - z;
  out.outside = max(max(max(ox, -ox), max(oy, -oy)), max(oz, -oz));
  return out;
}

GLOAM_HD float interpolate(const Shape& s, const float* f, const Between& b) {
  const float* p = f + b.c;
  const int sy = s.sy, sz = s.sz;
  const float a00 = p[0] + b.x * (p[1] - p[0]);
  const float a10 = p[sy] + b.x * (p[sy + 1] - p[sy]);
  const float a01 = p[sz] + b.x * (p[sz + 1] - p[sz]);
  const float a11 = p[sy + sz] + b.x * (p[sy + sz + 1] - p[sy + sz]);
  const float a0 = a00 + b.y * (a10 - a00), a1 = a01 + b.y * (a11 - a01);
  return a0 + b.z * (a1 - a0);
}

/// Also the least and the greatest of the eight values around.
GLOAM_HD float interpolate(const Shape& s, const float* f, const Between& b, float* least,
                           float* most) {
  const float* p = f + b.c;
  const int sy = s.sy, sz = s.sz;
  const float v0 = p[0], v1 = p[1], v2 = p[sy], v3 = p[sy + 1];
  const float v4 = p[sz], v5 = p[sz + 1], v6 = p[sy + sz], v7 = p[sy + sz + 1];
  *least = min(min(min(v0, v1), min(v2, v3)), min(min(v4, v5), min(v6, v7)));
  *most = max(max(max(v0, v1), max(v2, v3)), max(max(v4, v5), max(v6, v7)));
  const float a00 = v0 + b.x * (v1 - v0), a10 = v2 + b.x * (v3 - v2);
  const float a01 = v4 + b.x * (v5 - v4), a11 = v6 + b.x * (v7 - v6);
  const float a0 = a00 + b.y * (a10 - a00), a1 = a01 + b.y * (a11 - a01);
  return a0 + b.z * (a1 - a0);
}

/// Along one axis of a walk. o: from the cell's centre; the air slides along what is closed, half a
/// voxel before it, where nothing from beyond is mixed in.
GLOAM_HD bool walk_axis(const float* open, int stride, int n, float step, int* i, int* c,
                        float* o) {
  *o += step;
  bool blocked = false;
  const int face = *c + (*o > 0.0f ? stride : 0);
  if (*o != 0.0f && open[face] == 0.0f) {
    *o = 0.0f;
    blocked = true;
  }
  if (*o > 0.5f && *i < n) *i += 1, *c += stride, *o -= 1.0f;
  if (*o < -0.5f && *i >= 0) *i -= 1, *c -= stride, *o += 1.0f;
  return blocked;
}

/// From the centre of cell (i, j, k) by d voxels, past what is closed; true if that changed it.
GLOAM_HD bool walk(const Shape& s, const Faces<const float>& open, int i, int j, int k, Vec3f* d) {
  const float far = max(max(max(d->x, -d->x), max(d->y, -d->y)), max(d->z, -d->z));
  const int steps = int(far * 2.0f) + 1;
  const Vec3f step = *d * (1.0f / float(steps));
  int a = i, b = j, e = k, c = s.at(i, j, k);
  Vec3f o;
  bool blocked = false;
  for (int n = 0; n < steps; ++n) {
    // Outside of the box there are no faces, and nothing in the way.
    if (a < 0 || a >= s.nx || b < 0 || b >= s.ny || e < 0 || e >= s.nz) {
      o += step * float(steps - n);
      break;
    }
    blocked |= walk_axis(open.x, 1, s.nx, step.x, &a, &c, &o.x);
    if (a < 0 || a >= s.nx) continue;
    blocked |= walk_axis(open.y, s.sy, s.ny, step.y, &b, &c, &o.y);
    if (b < 0 || b >= s.ny) continue;
    blocked |= walk_axis(open.z, s.sz, s.nz, step.z, &e, &c, &o.z);
  }
  *d = {float(a - i) + o.x, float(b - j) + o.y, float(e - k) + o.z};
  return blocked;
}

/// Velocities of cells' centres, in voxels per step.
struct Carrier {
  Shape shape;
  Faces<const float> velocity;
};

/// By how much the air of the centre of cell (i, j, k) moved in a step (Runge and Kutta, order 2),
/// where nothing is in the way.
GLOAM_HD Vec3f displacement(const Carrier& v, int i, int j, int k) {
  const int c = v.shape.at(i, j, k);
  const Between b = place(v.shape, -1, float(i) - 0.5f * v.velocity.x[c],
                          float(j) - 0.5f * v.velocity.y[c], float(k) - 0.5f * v.velocity.z[c]);
  return {interpolate(v.shape, v.velocity.x, b), interpolate(v.shape, v.velocity.y, b),
          interpolate(v.shape, v.velocity.z, b)};
}

/// The same near walls. True if something was in the way.
GLOAM_HD bool displacement_near_walls(const Carrier& v, const Faces<const float>& open, int i,
                                      int j, int k, Vec3f* moved) {
  const int c = v.shape.at(i, j, k);
  Vec3f half = Vec3f{v.velocity.x[c], v.velocity.y[c], v.velocity.z[c]} * -0.5f;
  bool blocked = walk(v.shape, open, i, j, k, &half);
  const Between b =
      place(v.shape, -1, float(i) + half.x, float(j) + half.y, float(k) + half.z);
  Vec3f whole = -Vec3f{interpolate(v.shape, v.velocity.x, b), interpolate(v.shape, v.velocity.y, b),
                       interpolate(v.shape, v.velocity.z, b)};
  blocked |= walk(v.shape, open, i, j, k, &whole);
  *moved = -whole;
  return blocked;
}

}  // namespace gloam::gas
