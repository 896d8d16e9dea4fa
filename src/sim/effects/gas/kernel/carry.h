#pragma once
// Velocity carried along itself, a face at a time. Device-safe.

#include "sim/effects/gas/kernel/trace.h"

namespace gloam::gas {

/// Over this many voxels of its way from outside, air takes on what it meets at the border.
inline constexpr float kInflow = 4;

/// One component of velocity, on the lattice of faces across `axis`.
struct CarryView {
  Shape shape;
  int axis;
  int stride;                 ///< from the cell before a face to that beyond
  float wind;                 ///< wind of the air outside of the box
  float side[6];              ///< -x +x -y +y -z +z; 1 = open, 0 = closed
  Faces<const float> moved;   ///< displacement of cells' air [voxels]
  Faces<const float> centre;  ///< velocity of cells [voxels per step]
  const float* trusted;       ///< trust of cells: 0 where something was in the way
  const float* open;
  const float* old;  ///< the component
  float* carried;    ///< result of first order
  float* least;      ///< among the values that it was interpolated from
  float* most;
  float* corrected;  ///< the result
};

/// Distance of a place beyond an open side [voxels].
GLOAM_HD float outside(const CarryView& v, float x, float y, float z) {
  const float hx = float(v.shape.nx - (v.axis != 0)), hy = float(v.shape.ny - (v.axis != 1)),
              hz = float(v.shape.nz - (v.axis != 2));
  const float ox = max(v.side[0] * -x, v.side[1] * (x - hx));
  const float oy = max(v.side[2] * -y, v.side[3] * (y - hy));
  const float oz = max(v.side[4] * -z, v.side[5] * (z - hz));
  return max(max(max(ox, oy), oz), 0.0f);
}

/// Path of the air of a face, backwards or forwards in time.
struct Way {
  Between at;
  float past;  ///< distance of that place beyond an open side [voxels]
};

GLOAM_HD Way way_back(const CarryView& v, int i, int j, int k) {
  const int c = v.shape.at(i, j, k), b = c - v.stride;
  const float x = float(i) - 0.5f * (v.moved.x[c] + v.moved.x[b]),
              y = float(j) - 0.5f * (v.moved.y[c] + v.moved.y[b]),
              z = float(k) - 0.5f * (v.moved.z[c] + v.moved.z[b]);
  return {place(v.shape, v.axis, x, y, z), outside(v, x, y, z)};
}

/// Sets carried, least and most of a face; `a`: the old values around its way_back().
GLOAM_HD void set_carried(const CarryView& v, int c, const Corners& a, const Way& way) {
  const float value = interpolate(a, way.at);
  v.least[c] = min(min(min(a.v0, a.v1), min(a.v2, a.v3)), min(min(a.v4, a.v5), min(a.v6, a.v7)));
  v.most[c] = max(max(max(a.v0, a.v1), max(a.v2, a.v3)), max(max(a.v4, a.v5), max(a.v6, a.v7)));
  v.carried[c] = value + (v.wind - value) * min(way.past * (1.0f / kInflow), 1.0f);
}

GLOAM_HD void carry_face(const CarryView& v, int i, int j, int k) {
  const Way way = way_back(v, i, j, k);
  set_carried(v, v.shape.at(i, j, k), corners(v.shape, v.old, way.at.c), way);
}

/// Forward by what the centres' paths would be there: twice the velocity less the way back. `past`:
/// of both ways.
GLOAM_HD Way way_forth(const CarryView& v, int i, int j, int k) {
  const int c = v.shape.at(i, j, k), b = c - v.stride;
  const float mx = 0.5f * (v.moved.x[c] + v.moved.x[b]), my = 0.5f * (v.moved.y[c] + v.moved.y[b]),
              mz = 0.5f * (v.moved.z[c] + v.moved.z[b]);
  const float x = float(i) + (v.centre.x[c] + v.centre.x[b]) - mx,
              y = float(j) + (v.centre.y[c] + v.centre.y[b]) - my,
              z = float(k) + (v.centre.z[c] + v.centre.z[b]) - mz;
  return {place(v.shape, v.axis, x, y, z),
          outside(v, x, y, z) + outside(v, float(i) - mx, float(j) - my, float(k) - mz)};
}

/// Sets the result: half of what is lost on the way there and back is given back, within the bounds
/// of what was there. What came or went past the border or a wall has no way back to compare. `a`:
/// the carried values around the face's way_forth().
GLOAM_HD void set_corrected(const CarryView& v, int c, const Corners& a, const Way& way) {
  const float first = v.carried[c], old = v.old[c];
  const float back = interpolate(a, way.at);
  const float second = clamp(first + 0.5f * (old - back), v.least[c], v.most[c]);
  // Products, not conditions: those would keep compilers from lanes.
  const float trusted = v.trusted[c] * v.trusted[c - v.stride];
  const float share = way.past > 0.0f ? 0.0f : trusted;
  const float value = first + share * (second - first);
  v.corrected[c] = old + v.open[c] * (value - old);
}

GLOAM_HD void correct_face(const CarryView& v, int i, int j, int k) {
  const Way way = way_forth(v, i, j, k);
  set_corrected(v, v.shape.at(i, j, k), corners(v.shape, v.carried, way.at.c), way);
}

/// New value of the component at an open side of the box through which wind comes in, even where
/// the air stands still; `share`: fraction of the difference to the wind that it takes on in the
/// step.
GLOAM_HD float let_in(const CarryView& v, int c, float share) {
  const float here = v.corrected[c];
  return v.open[c] > 0.0f ? here + (v.wind - here) * share : here;
}

}  // namespace gloam::gas
