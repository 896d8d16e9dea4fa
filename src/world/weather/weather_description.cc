#include "world/weather/weather_description.h"

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "world/render_description.h"
#include "world/weather/fallen_snow.h"
#include "world/weather/weather_air.h"

namespace gloam {
namespace {

// Water that a surface holds before it runs off, as rain: a porous millimetre [m].
constexpr double kHeldWater = 1e-3;
constexpr double kPerHour = 1e-3 / 3600;  // mm/h as m/s

}  // namespace

float WeatherDescription::wetness_at(double time) const {
  const double share = std::exp(-time / static_cast<double>(wetting_time));
  return static_cast<float>(wetness_end + (wetness_start - wetness_end) * share);
}

float WeatherDescription::snow_at(double time) const {
  // Three centimetres hide what is beneath but for one part in seven.
  constexpr double kCoverDepth = 0.015;  // [m]
  return static_cast<float>(1 - std::exp(-(snow_start + snow_rate * time) / kCoverDepth));
}

Status author_weather(const WeatherOptions& options, const WindDescription& wind,
                      std::span<const Region> rooms, const std::vector<Affine3f>& X_WB,
                      RenderDescription* out) {
  WeatherDescription& weather = out->weather;
  const double rain = options.rain.value_or(0), snow = options.snow.value_or(0);
  const uint64_t seed = weather.seed = wind.seed;
  weather.shelter = make_shelter_map(*out, X_WB);
  if (options.visibility) GLOAM_TRY_STATUS(add_fog(options, rooms, seed, out));
  const auto add = [&](ParticleSet particles) {
    particles.wind = {static_cast<float>(wind.speed * wind.along_x),
                      static_cast<float>(wind.speed * wind.along_y), 0};
    if (wind.gusts > 0) particles.gusts = std::make_shared<const Gusts>(wind);
    particles.seed = seed + weather.particles.size();
    add_falling(particles, options, out);
    weather.particles.push_back(std::move(particles));
  };
  if (rain > 0) {
    add(rain_particles(rain));
    for (const ParticleClass& drop : weather.particles.back().classes)
      if (drop.diameter >= 1e-3f) weather.impacts += drop.number * drop.fall_speed;
    weather.drips = find_drip_edges(*weather.shelter, rain * kPerHour);
  }
  if (snow > 0) add(snow_particles(snow));
  // From soaked without a film to half of what is level under water in a cloudburst.
  weather.wetness_end = rain > 0 ? static_cast<float>(0.5 + 0.25 * rain / (rain + 10)) : 0;
  weather.wetness_start =
      static_cast<float>(options.wetness.value_or(static_cast<double>(weather.wetness_end)));
  // Without rain it dries, at half a millimetre an hour.
  weather.wetting_time = static_cast<float>(kHeldWater / (std::max(rain, 0.5) * kPerHour));
  weather.snow_start = static_cast<float>(options.snow_cover.value_or(0));
  weather.snow_rate = static_cast<float>(snow_growth(options));
  weather.lens_drops = static_cast<float>(options.lens_drops.value_or(0));
  weather.drops_fall_on_lenses = rain > 0;
  return {};
}

}  // namespace gloam
