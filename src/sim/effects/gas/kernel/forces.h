#pragma once
// What speeds gas up: heat, the weight of smoke, and eddies that a coarse grid loses. Device-safe.

#include "sim/effects/gas/kernel/reaction.h"

namespace gloam::gas {

/// Upward acceleration [m/s²] of gas whose excess heat is `heat` of ambient air's: it weighs
/// 1 - heat of it, whatever its temperature; smoke of `smoke` kg/m³ weighs it down.
GLOAM_HD float buoyancy(float heat, float smoke, float ambient_density) {
  return kGravity * (heat - smoke / ambient_density);
}

/// Curl at c of velocities of cells' centres, times two voxels.
GLOAM_HD Vec3f curl(const Shape& s, const Faces<const float>& v, int c) {
  const int x = 1, y = s.sy, z = s.sz;
  return {(v.z[c + y] - v.z[c - y]) - (v.y[c + z] - v.y[c - z]),
          (v.x[c + z] - v.x[c - z]) - (v.z[c + x] - v.z[c - x]),
          (v.y[c + x] - v.y[c - x]) - (v.x[c + y] - v.x[c - y])};
}

/// Acceleration that spins eddies up (Fedkiw, Stam and Jensen 2001), over strength times voxel
/// times what curl() is too large by. `strength`: length of curl().
GLOAM_HD Vec3f confinement(const Shape& s, const Faces<const float>& v, const float* strength,
                           int c) {
  const Vec3f g{strength[c + 1] - strength[c - 1], strength[c + s.sy] - strength[c - s.sy],
                strength[c + s.sz] - strength[c - s.sz]};
  const float far = sqrtf(dot(g, g)) + 1e-6f;
  return cross(g, curl(s, v, c)) * (1.0f / far);
}

}  // namespace gloam::gas
