#include "world/weather/wind_description.h"

#include <cmath>
#include <numbers>

#include "places/generators.h"

namespace gloam {
namespace {

// Fraction of the mean: open, flat country (Stull 1988, chapter 4)
constexpr double kDefaultGusts = 0.15;

bool is_under_the_sky(const EnvironmentOptions& environment) {
  return !has_generator(environment) || environment.terrain.has_value();
}

}  // namespace

WindDescription describe_wind(const Scene& scene, const WeatherOptions& weather) {
  WindDescription wind;
  wind.seed = scene.sim.seed;
  if (!weather.wind || !is_under_the_sky(scene.environment)) return wind;
  wind.speed = *weather.wind;
  wind.gusts = weather.gusts.value_or(kDefaultGusts) * wind.speed;
  // An azimuth is clockwise from north; north is +Y, turned counter-clockwise by the sky's own.
  constexpr double kDegree = std::numbers::pi / 180;
  const double north = scene.sky ? scene.sky->north.value_or(0) : 0;
  const double from = (weather.wind_from - north) * kDegree;
  wind.along_x = -std::sin(from);
  wind.along_y = -std::cos(from);
  return wind;
}

}  // namespace gloam
