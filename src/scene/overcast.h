#pragma once
// The sky over rain and snow where a scene has none of its own.

#include <optional>

#include "gloam/scene.h"

namespace gloam {

/// Even clouds: 15 000 lx on the ground under a drizzle, half of that at 10 mm/h (an overcast day
/// has 1 000 to 20 000 lx; CIE S 011's overcast sky is darker towards the horizon, this one is
/// not). Nothing where nothing falls.
std::optional<SkyOptions> overcast_sky(const WeatherOptions& weather);

/// Exposure for a scene in the open under it: of an incident meter with C = 250 (ISO 2720).
double overcast_ev100(const SkyOptions& sky);

}  // namespace gloam
