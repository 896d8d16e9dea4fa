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

/// k_u at the sinkage z_u [N/m³]. Wong's line was fitted to deep sinkages: at shallow ones, where
/// it would be flatter than loading, it is three times as steep as that.
inline double unloading_of(const SoilStrength& s, double z_u, double p_u) {
  constexpr double kLeast = 3;
  const double wong = s.k_0 + s.a_u * z_u, least = kLeast * p_u / (z_u > 0 ? z_u : 1.0);
  return wong > least ? wong : least;
}

/// What a cell has been through.
struct SoilCell {
  float sinkage = 0;     ///< z_u: from which it unloads [m]; 0 = nothing has pressed it
  float pressure = 0;    ///< p_u: at that sinkage [Pa]
  float shear[3] = {};   ///< stress over tau_max on what is in it, world, 0 … 1
  uint32_t touched = 0;  ///< step after the one that something was last in it

  /// k_u [N/m³].
  double unloading(const SoilStrength& s) const {
    return unloading_of(s, double{sinkage}, double{pressure});
  }
};

}  // namespace gloam
