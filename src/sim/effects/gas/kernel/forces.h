#pragma once
// Forces on gas: buoyancy of heat, the weight of smoke, and eddies that a coarse grid loses.
// Device-safe.

#include "sim/effects/gas/kernel/reaction.h"

namespace gloam::gas {

/// Upward acceleration [m/s²] of gas whose excess heat is `heat` of ambient air's: it weighs
/// 1 - heat of it, whatever its temperature; smoke of `smoke` kg/m³ weighs it down.
GLOAM_HD float buoyancy(float heat, float smoke, float ambient_density) {
  return kGravity * (heat - smoke / ambient_density);
}

/// Fluctuations of temperature that a grid does not resolve, over their mean's rise. Real ones are
/// 0.4 on the axis of plumes and more than one towards their rim (McCaffrey 1979; George, Alpert
/// and Tamanini 1977), but last for longer than a substep. Without them plumes stay laminar for
/// metres, mix with too little air and rise too fast, then swing to and fro; of this strength they
/// rise and mix as measured in voxels of 0.1 and 0.16 m (gas_flow_test.cc).
inline constexpr float kFluctuation = 2.2f;
/// Fall of heat from a cell to the one above, over the sum of both, from which on gas overturns.
inline constexpr float kConvectionThreshold = 0.05f;

/// MurmurHash3's finaliser: lanes compute it too.
GLOAM_HD uint32_t mix_bits(uint32_t x) {
  x = (x ^ (x >> 16)) * 0x85EBCA6Bu;
  x = (x ^ (x >> 13)) * 0xC2B2AE35u;
  return x ^ (x >> 16);
}

/// Uniform, of mean 0 and variance 1, by cell and count.
GLOAM_HD float fluctuation(int c, uint32_t count) {
  const uint32_t bits = mix_bits(uint32_t(c) ^ mix_bits(count));
  return (float(int(bits >> 8)) * 0x1p-23f - 1.0f) * 1.7320508f;
}

/// Inputs of the lift on faces across z.
struct LiftView {
  Shape shape;
  const float* open;
  const float* smooth;  ///< smoothness_at() of cells
  const float* heat;
  const float* smoke;
  float ambient_density;  ///< [kg/m³]
  float dt;               ///< [s]
  uint32_t count;         ///< counter of fluctuation()
};

/// Velocity that the face at c gains [m/s]. Where flow is not smooth, or warm gas lies below
/// colder, heat fluctuates; layers at rest, warm above cold, stay so.
GLOAM_HD float lift(const LiftView& v, int c) {
  const int b = c - v.shape.sz;
  const float rough = 1.0f - 0.5f * (v.smooth[c] + v.smooth[b]);
  const float heat = v.heat[c] + v.heat[b];
  const float overturns = clamp(
      (v.heat[b] - v.heat[c]) / (kConvectionThreshold * heat + kMinConcentration), 0.0f, 1.0f);
  const float share = 1.0f + kFluctuation * max(rough, overturns) * fluctuation(c, v.count);
  return v.open[c] * v.dt *
         buoyancy(share * 0.5f * heat, 0.5f * (v.smoke[c] + v.smoke[b]), v.ambient_density);
}

/// 1 where velocities of cells' centres [voxels per step] change by little from cell to cell, 0
/// from kRough on.
GLOAM_HD float smoothness_at(const Shape& s, const Faces<const float>& v, int c) {
  constexpr float kRough = 0.4f;
  float sum = 0;
  for (int a = 0; a < 3; ++a) {
    const float* f = v[a];
    const float x = f[c + 1] - f[c - 1], y = f[c + s.sy] - f[c - s.sy],
                z = f[c + s.sz] - f[c - s.sz];
    sum += x * x + y * y + z * z;
  }
  return clamp(1.5f - sqrtf(sum) * (0.75f / kRough), 0.0f, 1.0f);
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
