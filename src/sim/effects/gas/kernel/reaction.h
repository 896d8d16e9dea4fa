#pragma once
// Processes inside a voxel: burning, cooling, settling of smoke. Device-safe.

#include "sim/effects/gas/kernel/transport.h"

namespace gloam::gas {

inline constexpr float kAirDensity = 1.204f;  ///< at 293 K and 101325 Pa [kg/m³]
/// Heat capacity of air at constant pressure [J/(kg K)]
inline constexpr float kHeatCapacity = 1006.f;
inline constexpr float kGravity = 9.81f;  ///< [m/s²]
/// No gas of an open fire is hotter (adiabatic flames of hydrocarbons in air: 2250 K) [K].
inline constexpr float kHottest = 2300.0f;
/// Air per fuel of complete burning [kg/kg]; polyurethane: 9.4 (SFPE Handbook, Drysdale: 13.1 MJ
/// per kg of oxygen, whatever burns; 25 MJ/kg / 13.1 / 0.232).
inline constexpr float kHeatPerAir = 13.1e6f * 0.232f;  ///< [J/kg]

/// Concentrations below this are none: what decays for ever would slow processors down [kg/m³].
inline constexpr float kMinConcentration = 1e-12f;

/// GasProperties as a step needs them.
struct ReactionRates {
  float density = 0;           ///< density of ambient air [kg/m³]
  float heat_unit = 0;         ///< density cp T of ambient air [J/m³]
  float hottest = 0;           ///< limit of kHeat
  float burn = 0;              ///< fraction of the mixed fuel that burns in the step
  float heat_per_fuel = 0;     ///< heat that stays in the gas, in heat_unit per [kg/m³]
  float air_per_fuel = 0;      ///< [kg/kg]
  float soot_yield = 0;        ///< [kg/kg]
  float cool = 0, settle = 0;  ///< fractions lost in the step
};

struct Reaction {
  float heat_made, heat_lost, burnt, settled;
};

/// Changes the scalars of one cell. `heated`: what sources add to kHeat; out: all that kHeat gains,
/// which is the volume that the cell must give off.
GLOAM_HD Reaction react(const ReactionRates& r, float* heat, float* smoke, float* fuel,
                        float* spent, float* heated) {
  Reaction out;
  // The remainder, neither fuel nor product of burning, is air, thinned by its heat.
  const float air =
      max(r.density * (1.0f - *heat) - *fuel - *spent * (1.0f + 1.0f / r.air_per_fuel), 0.0f);
  out.burnt = r.burn * min(*fuel, air / r.air_per_fuel);
  *fuel -= out.burnt;
  *spent += out.burnt * r.air_per_fuel;
  out.settled = *smoke * r.settle;
  *smoke = *smoke - out.settled + out.burnt * r.soot_yield;
  out.heat_made = out.burnt * r.heat_per_fuel;
  const float sum = *heat + *heated + out.heat_made;
  const float kept = min(sum - *heat * r.cool, r.hottest);
  out.heat_lost = sum - kept;
  *heated = kept - *heat;
  *heat = kept < kMinConcentration ? 0.0f : kept;
  *smoke = *smoke < kMinConcentration ? 0.0f : *smoke;
  *fuel = *fuel < kMinConcentration ? 0.0f : *fuel;
  *spent = *spent < kMinConcentration ? 0.0f : *spent;
  return out;
}

}  // namespace gloam::gas
