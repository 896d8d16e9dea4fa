#pragma once
// Transport of smoke, heat and fuel: the amount that leaves a cell enters its neighbour, so mass is
// kept to rounding; one axis after the other. The reconstructed quantity (van Leer 1977) is the
// ratio to air that is carried along (Easter 1993), so that an even mixture stays even whatever the
// flow along one axis alone. Device-safe.

#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

inline constexpr int kScalars = 4;
/// Excess heat over rho cp T of ambient air, soot, fuel, and air spent by burning [kg/m³].
enum Scalar { kHeat = 0, kSmoke = 1, kFuel = 2, kSpent = 3 };

/// Slope of van Leer's limiter from the differences to both sides, over the cell.
GLOAM_HD float limited_slope(float before, float after) {
  const float product = before * after;
  const float sum = before + after;
  return product > 0.0f ? 2.0f * product / sum : 0.0f;
}

/// Through a face, per cell's volume: `courant` = speed dt / voxel, 0 where closed. q: ratios in
/// the two cells before and the two beyond; d01: 0 where the face between q0 and q1 is closed, else
/// q1 - q0. air0, air1: in the cells before and beyond. None leaves that is not there as long as
/// what leaves a cell is no more than its air.
GLOAM_HD float face_flux(float courant, float q1, float q2, float d01, float d12, float d23,
                         float air1, float air2) {
  const bool on = courant > 0.0f;
  const float air = on ? air1 : air2;
  const float q = on ? q1 : q2;
  const float slope = limited_slope(on ? d01 : d12, on ? d12 : d23);
  const float moved = courant < 0.0f ? -courant : courant;
  const float rest = 0.5f * (1.0f - moved / air);
  return courant * (on ? q + rest * slope : q - rest * slope);
}

/// Air that is left in the cell at c by the sweeps along the axes `before` (-1 = none): of 1, what
/// they moved is gone.
GLOAM_HD float air_left(const Shape& s, const Faces<const float>& courant, const int (&before)[2],
                        int c) {
  float air = 1.0f;
  for (const int a : before) {
    if (a >= 0) air -= courant[a][c + s.stride(a)] - courant[a][c];
  }
  return air;
}

/// The most that leaves the cell at c in a sweep along one axis, and in net in those along the
/// others, which may come before it: of its air, in whichever order. `courant`: of faces.
GLOAM_HD float most_outflow(const Shape& s, const Faces<const float>& courant, int c) {
  const float xl = courant.x[c], xh = courant.x[c + 1], yl = courant.y[c], yh = courant.y[c + s.sy],
              zl = courant.z[c], zh = courant.z[c + s.sz];
  const float x = max(xh - xl, 0.0f), y = max(yh - yl, 0.0f), z = max(zh - zl, 0.0f);
  const float out_x = max(xh, 0.0f) - min(xl, 0.0f), out_y = max(yh, 0.0f) - min(yl, 0.0f),
              out_z = max(zh, 0.0f) - min(zl, 0.0f);
  return max(max(out_x + (y + z), out_y + (x + z)), out_z + (x + y));
}

}  // namespace gloam::gas
