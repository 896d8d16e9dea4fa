#pragma once
// Composition of the air over a place at each height.

namespace gloam {

inline constexpr double kEarthRadius = 6371e3;              ///< at sea level [m]
inline constexpr double kTopRadius = kEarthRadius + 100e3;  ///< outer radius of the air [m]

/// Molecules at sea level [1/m³], and how high all would reach at that density [m]: 1013.25 hPa at
/// 288.15 K.
inline constexpr double kMolecules = 2.546899e25, kMoleculeColumn = 8435;
/// The same length for the aerosol, which falls off exponentially, and for ozone, from its peak
/// [m].
inline constexpr double kAerosolColumn = 1200, kOzoneColumn = 15e3;

/// Molecules and aerosol relative to sea level, ozone relative to its peak.
struct Densities {
  double molecules = 0, aerosol = 0, ozone = 0;
};
/// At `radius` [m] from the centre of the earth, up to kTopRadius. Molecules: U.S. Standard
/// Atmosphere 1976. Ozone: a triangle from 10 to 40 km.
Densities densities(double radius);

}  // namespace gloam
