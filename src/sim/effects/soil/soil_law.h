#pragma once
// Resistance of a bed of soil to pressure and shear:
//   loading      p = (k_c / b + k_phi) z^n                              Bekker 1956, 1969
//   unloading    p = p_u - k_u (z_u - z), k_u = k_0 + a_u z_u           Wong 2008, section 2.4
//   shear        d tau = (tau_max d - tau) |dj| / K, against the motion d; from rest that is
//                tau = tau_max (1 - e^(-j/K))                           Janosi and Hanamoto 1961
//                tau_max = c + p tan(phi)                               Mohr and Coulomb
// The ground does not pull.

#include <algorithm>
#include <cmath>

#include "world/effects/soil_description.h"

namespace gloam {

/// Lines of unloading are so many times as steep as those to the origin, at least: at shallow
/// sinkages Wong's, which was fitted to deep ones, would be flatter than loading.
constexpr double kMinUnloadingSlopeRatio = 3;

/// k_u [N/m³] at the sinkage z_u [m], where the pressure is p_u [Pa].
inline double unloading_of(const SoilStrength& s, double z_u, double p_u) {
  const double wong = s.k_0 + s.a_u * z_u,
               least = kMinUnloadingSlopeRatio * p_u / (z_u > 0 ? z_u : 1.0);
  return wong > least ? wong : least;
}

/// The line of unloading at a sinkage `z` [m].
struct SoilLine {
  double p, slope;  ///< [Pa], [N/m³]
};

/// `per_z`: of the loading curve at z, its pressure over z [N/m³]. Further in than before the line
/// is as steep as one from there: after a touch by a hair it would stay below the curve where that
/// is convex.
inline SoilLine unloading_line(double z_u, double p_u, double k_u, double per_z, double z) {
  const double steeper = kMinUnloadingSlopeRatio * per_z;
  const double slope = ((z > z_u) & (steeper > k_u)) ? steeper : k_u;
  return {p_u - slope * (z_u - z), slope};
}

/// History of a cell.
struct SoilCell {
  float sinkage = 0;     ///< z_u: from which it unloads, below the surface of time 0 [m]
  float pressure = 0;    ///< p_u: at that sinkage [Pa]; 0 = nothing has pressed it
  float shear[3] = {};   ///< stress over tau_max on what is in it, world, 0 … 1
  uint32_t touched = 0;  ///< step after the one that something was last in it

  /// Below the surface after `fallen` [m] of snow have come to the cell.
  double sinkage_under(double fallen) const { return double{sinkage} + fallen; }
  /// k_u [N/m³] after that.
  double unloading(const SoilStrength& s, double fallen) const {
    return unloading_of(s, sinkage_under(fallen), double{pressure});
  }
};

}  // namespace gloam
