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
  static constexpr double kSteeper = 3;  ///< lines of unloading than those to the origin, at least

  float sinkage = 0;     ///< z_u: from which it unloads, below the surface of time 0 [m]
  float pressure = 0;    ///< p_u: at that sinkage [Pa]; 0 = nothing has pressed it
  float shear[3] = {};   ///< stress over tau_max on what is in it, world, 0 … 1
  uint32_t touched = 0;  ///< step after the one that something was last in it

  /// Below the surface after `fallen` [m] of snow have come to the cell.
  double sinkage_under(double fallen) const { return double{sinkage} + fallen; }

  /// k_u [N/m³] at a sinkage `z` below the present surface [m]. Wong's line was fitted to deep
  /// sinkages: at shallow ones, where it would be flatter than loading, it is three times as steep
  /// as that.
  double unloading(const SoilStrength& s, double z) const {
    return std::max(s.k_0 + s.a_u * z, kSteeper * double{pressure} / z);
  }
};

/// Pressure at a sinkage, and what it grows by with it.
struct SoilPressure {
  double p = 0;         ///< [Pa]
  double slope = 0;     ///< dp/dz [N/m³]
  bool yields = false;  ///< it is on the loading curve
};

/// Of a cell, where a bed is so deep and so much of that has fallen since time 0.
struct SoilDepth {
  double depth = 0, fallen = 0;  ///< [m]
};

/// `modulus`: k_c / b + k_phi [N/m^(n+2)], `z`: sinkage [m]; beyond the depth the pressure stays as
/// it is.
inline SoilPressure soil_pressure(const SoilStrength& s, const SoilCell& cell, double modulus,
                                  SoilDepth here, double z) {
  if (z <= 0 || here.depth <= 0) return {};
  const double loading = modulus * std::pow(std::min(z, here.depth), s.n);
  if (cell.pressure > 0) {
    const double deepest = cell.sinkage_under(here.fallen);
    // Further in than before the line is as steep as one from there: after a touch by a hair it
    // would stay below the curve where that is convex.
    double k_u = cell.unloading(s, deepest);
    if (z > deepest) k_u = std::max(k_u, SoilCell::kSteeper * loading / z);
    const double p = double{cell.pressure} - k_u * (deepest - z);
    if (p <= 0) return {};
    if (p < loading) return {p, k_u, false};
  }
  return {loading, z < here.depth ? s.n * loading / z : 0, true};
}

}  // namespace gloam
