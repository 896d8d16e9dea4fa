#pragma once
// Amount of dust that ground gives, by published laws. Guesses, where they leave something open,
// are marked as such.

#include <algorithm>
#include <cmath>

namespace gloam {

/// Aerodynamic roughness length of bare, loose ground [m]. Measured: 0.1 to 1 mm.
inline constexpr double kGroundRoughness = 5e-4;

/// Friction velocity [m/s] of air that moves at `speed` [m/s] at a height [m]: law of the wall.
inline double friction_velocity(double speed, double height) {
  constexpr double kKarman = 0.4;
  return kKarman * speed / std::log(std::max(height / kGroundRoughness, 10.0));
}

/// Dust that saltating grains raise [kg/(m² s)]: White's flux of grains (1979) times the ratio of
/// dust to it by the soil's fraction of clay, up to 0.2, after Marticorena and Bergametti 1995. All
/// above the threshold friction velocity [m/s]. `density`: of the air [kg/m³].
inline double saltation_dust(double friction_velocity, double threshold, double clay,
                             double density) {
  if (!(friction_velocity > threshold)) return 0;
  const double r = threshold / friction_velocity;
  const double cube = friction_velocity * friction_velocity * friction_velocity;
  const double grains = 2.61 * density / 9.81 * cube * (1 + r) * (1 - r * r);  // [kg/(m s)]
  return grains * 100 * std::pow(10.0, 13.4 * std::min(clay, 0.2) - 6);        // ratio in 1/cm
}

/// Dust that a vehicle of a mass [kg] raises per way it rolls [kg/m]: EPA, AP-42, section 13.2.2
/// (2006), equation 1a for particles up to 30 µm, by the fraction of silt. The law was fitted to
/// vehicles of 1.8 to 260 t; robots are far below.
inline double rolling_dust(double silt, double mass) {
  constexpr double kPerMile = 281.9e-6;  // 1 lb per mile [kg/m]
  constexpr double kShortTon = 907.185;  // [kg]
  return 4.9 * kPerMile * std::pow(silt / 0.12, 0.7) * std::pow(mass / (3 * kShortTon), 0.45);
}

/// Dust per energy that slipping and impacts leave in the ground [kg/J]. A guess: that of the law
/// above for the vehicle it is normalised to, 3 short tons with a coefficient of rolling resistance
/// of 0.03, per what its tyres lose.
inline double dust_per_energy(double silt) {
  constexpr double kMass = 3 * 907.185, kRollingResistance = 0.03;
  return rolling_dust(silt, kMass) / (kRollingResistance * kMass * 9.81);
}

/// Energy that a foot leaves in the ground when a person of a mass [kg] walks at a speed [m/s], per
/// step [J]. A guess of the order of the collisions' work that Donelan, Kram and Kuo 2002 measured.
inline double step_energy(double mass, double speed) {
  const double share = speed / 1.25;
  return 0.2 * mass * share * share;
}

}  // namespace gloam
