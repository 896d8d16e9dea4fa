#pragma once
// How a bed of soil resists where it is pressed and sheared.
//   loading      p = (k_c / b + k_phi) z^n                              Bekker 1956, 1969
//   unloading    p = p_u - k_u (z_u - z), k_u = k_0 + a_u z_u           Wong 2008, section 2.4
//   shear        d tau = (tau_max d - tau) |dj| / K, against the motion d; from rest that is
//                tau = tau_max (1 - e^(-j/K))                           Janosi and Hanamoto 1961
//                tau_max = c + p tan(phi)                               Mohr and Coulomb
// The ground does not pull.

#include <algorithm>
#include <cmath>

#include "world/soil_description.h"

namespace gloam {

/// What a cell has been through.
struct SoilCell {
  float sinkage = 0;     ///< z_u: from which it unloads [m]; 0 = nothing has pressed it
  float pressure = 0;    ///< p_u: at that sinkage [Pa]
  float shear[3] = {};   ///< stress over tau_max on what is in it, world, 0 … 1
  uint32_t touched = 0;  ///< step after the one that something was last in it

  /// k_u [N/m³]. Wong's line was fitted to deep sinkages: at shallow ones, where it would be
  /// flatter than loading, it is three times as steep as that.
  double unloading(const SoilStrength& s) const {
    constexpr double kLeast = 3;
    return std::max(s.k_0 + s.a_u * double{sinkage}, kLeast * double{pressure} / double{sinkage});
  }
};

/// Pressure at a sinkage, and what it grows by with it.
struct SoilPressure {
  double p = 0;         ///< [Pa]
  double slope = 0;     ///< dp/dz [N/m³]
  bool yields = false;  ///< it is on the loading curve
};

/// `modulus`: k_c / b + k_phi [N/m^(n+2)], `z`: sinkage [m], `depth`: of the bed; beyond it the
/// pressure stays as it is [m].
inline SoilPressure soil_pressure(const SoilStrength& s, const SoilCell& cell, double modulus,
                                  double depth, double z) {
  if (z <= 0) return {};
  SoilPressure out;
  if (cell.sinkage > 0) {
    const double k_u = cell.unloading(s);
    out.p = double{cell.pressure} - k_u * (double{cell.sinkage} - z);
    out.slope = k_u;
    if (out.p <= 0) return {};
  }
  const double loading = modulus * std::pow(std::min(z, depth), s.n);
  if (cell.sinkage > 0 && out.p < loading) return out;
  return {loading, z < depth ? s.n * loading / z : 0, true};
}

}  // namespace gloam
