#pragma once
// The weather of a World as sensors see it: what falls, what hangs in the air, what it leaves on
// surfaces and lenses. Pure functions of time. docs/weather.md has the models.

#include <memory>
#include <span>
#include <vector>

#include "gloam/scene/environment.h"
#include "gloam/scene/sky.h"
#include "world/weather/particle_set.h"
#include "world/weather/roof_drips.h"
#include "world/weather/shelter_map.h"
#include "world/weather/wind_description.h"

namespace gloam {

struct WeatherDescription {
  std::vector<ParticleSet> particles;
  /// Nothing that falls gets under it; null = nothing falls or lies.
  std::shared_ptr<const ShelterMap> shelter;
  std::vector<DripEdge> drips;               ///< edges from which rain drips
  float wetness_start = 0, wetness_end = 0;  ///< wetness of surfaces under the open sky, 0 … 1
  float wetting_time = 1;                    ///< time constant from one to the other [s]
  float impacts = 0;  ///< rate of drops of a millimetre and more on level ground [1/(m² s)]
  float snow_start = 0, snow_rate = 0;  ///< depth of snow on level ground [m], [m/s]
  float lens_drops = 0;                 ///< fraction of the picture, 0 … 1
  bool drops_fall_on_lenses = false;    ///< they come and go
  uint64_t seed = 0;

  float wetness_at(double time) const;
  /// Depth as the amount of surface/weathering.h, 0 … 1.
  float snow_at(double time) const;
  bool covers_surfaces() const {
    return wetness_start > 0 || wetness_end > 0 || snow_start > 0 || snow_rate > 0;
  }
};

struct RenderDescription;

/// Fills `weather` of the description, whose instances are all there, and appends the media and
/// volumes of fog, rain and snow. `rooms`: of the generated building; `X_WB`: of all bodies.
/// Errors: no such medium.
Status author_weather(const WeatherOptions& options, const WindDescription& wind,
                      std::span<const Region> rooms, const std::vector<Affine3f>& X_WB,
                      RenderDescription* out);

}  // namespace gloam
