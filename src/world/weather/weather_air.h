#pragma once
// Volumes of what the weather puts into the air. Their extent depends on [weather] alone, not on
// what stands in the place, so that a box or a larger floor changes nothing beyond itself.

#include <span>

#include "gloam/result.h"
#include "gloam/scene/environment.h"
#include "gloam/scene/sky.h"
#include "world/weather/particle_set.h"

namespace gloam {

struct RenderDescription;

/// Horizontal extent of the air with weather, to each side of its middle [m]. The middle is that of
/// the place, rounded to half of this, so that it stays where it is for places near the origin.
inline constexpr float kAirReach = 1000;
/// Depth to which it reaches below `base`, for valleys and pits [m].
inline constexpr float kAirDepth = 1000;
/// Height over `base` from which rain and snow fall [m].
inline constexpr float kFallHeight = 200;
/// Scale heights over `base` at which haze that thins with height ends: a thousandth is left.
inline constexpr float kScaleHeights = 7;

/// Appends the medium of the visibility: in the rooms, or everywhere from kAirDepth below `base` to
/// `height` over it; with a scale height to kScaleHeights of these. Error: no such medium.
Status add_fog(const WeatherOptions& options, std::span<const Region> rooms, uint64_t seed,
               RenderDescription* out);

/// Appends what falls as a medium, from kFallHeight over `base` to kAirDepth below, save where the
/// shelter map of `out` has a roof.
void add_falling(const ParticleSet& particles, const WeatherOptions& options,
                 RenderDescription* out);

}  // namespace gloam
