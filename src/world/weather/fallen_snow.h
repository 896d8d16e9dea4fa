#pragma once
// Snow that [weather] lays on the ground as a bed of soil: where it lies, and how deep.

#include "gloam/scene.h"
#include "world/effects/soil_description.h"

namespace gloam {

/// Depth of what falls on level ground under the sky [m/s].
double snow_growth(const WeatherOptions& weather);

/// Does the bed take its depth from the weather?
bool is_fallen_snow(const SoilOptions& soil, const std::optional<WeatherOptions>& weather);

/// Fills depth, growth, share, rest and level of a bed whose grid is there. False where there is no
/// ground below all of it. A bed that lies nowhere has a fraction of 0 in each cell.
bool lay_fallen_snow(const WeatherOptions& weather, const mjModel& model, double from,
                     SoilDescription* soil);

}  // namespace gloam
