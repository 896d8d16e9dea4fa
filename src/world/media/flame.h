#pragma once
// Flames as a medium. They are sheets much thinner than voxels, so the mean temperature of a voxel
// tells little of their light, which goes with some fifteenth power of temperature. Their heat
// release does: of it flames radiate a known fraction, from a known temperature.

#include <cmath>

#include "world/media/medium_description.h"

namespace gloam {

/// Temperature of what radiates in flames [K]: in luminous ones 1200 to 1700 K.
inline constexpr float kFlameTemperature = 1500;

/// Heat release of turbulent flames per volume [W/m³] (Orloff and de Ris 1982, "Froude modeling of
/// pool fires"): what releases so much is full of flame.
inline constexpr float kFlameHeatRelease = 1.2e6f;

/// Absorption of flames over their heat release [1/m per W/m³], by which thin ones radiate the
/// fraction `radiated` of it: 4 κ σ T⁴ = χ q. Thick ones shine as black bodies of kFlameTemperature
/// by the same κ. It is grey, as engineering takes flames (soot and hot gases together: Tien, Lee
/// and Stretton, SFPE Handbook, "Radiation heat transfer").
inline float flame_absorption_per_heat(float radiated) {
  constexpr double kStefanBoltzmann = 5.670374419e-8;  // [W/(m² K⁴)]
  return static_cast<float>(double{radiated} /
                            (4 * kStefanBoltzmann * std::pow(double{kFlameTemperature}, 4)));
}

/// The medium of a volume whose densities are κ [1/m].
inline MediumDescription flame_medium() {
  MediumDescription flame{.name = "flame", .emission = 1};
  flame.mass_extinction.fill(1);
  return flame;
}

}  // namespace gloam
