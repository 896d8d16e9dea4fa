#pragma once
// What falls, blows and hangs in the air of a scene file, and how hard it makes it: [weather] and
// [adversity]. Part of gloam/scene.h; docs/weather.md has the models and their sources.

#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [weather]: in numbers. What is not given is what the level of [adversity] says, and without one
/// fair. Rain and snow fall where the sky is open above.
struct WeatherOptions {
  std::optional<double> rain = {};        ///< [mm/h], default 0
  std::optional<double> snow = {};        ///< of water [mm/h], default 0
  std::optional<double> visibility = {};  ///< through what hangs in the air, by Koschmieder [m];
                                          ///< without rain and snow; default: clear
  std::string medium = "fog";  ///< what hangs, as of [[volume]]: fog mist haze dust smoke
  double scale_height = 0;     ///< over which it thins to 1/e above the lowest ground [m]; 0 = even
  double turbulence = 0;       ///< of its density: standard deviation over mean, 0 … 1
  std::optional<double> wind = {};  ///< mean speed 10 m above the ground [m/s], default 0
  double wind_from = 270;           ///< where it comes from, as of [sky]'s azimuth [deg]
  std::optional<double> gusts =
      {};  ///< standard deviation of its speed over the mean, default 0.15
  std::optional<double> wetness = {};  ///< of what the sky reaches, at the start, 0 … 1; default:
                                       ///< what the rain keeps it at
  std::optional<double> snow_cover = {};  ///< likewise: depth of snow at the start [m], default 0
  std::optional<double> lens_drops = {};  ///< share of cameras' front glass under drops, default 0
  SourceLoc loc = {};
};

/// [adversity]: a level, for which docs/weather.md has the numbers, and its numbers that stand
/// nowhere else.
struct AdversityOptions {
  std::string level = "none";          ///< none | minor | major
  std::optional<double> light = {};    ///< share of its light that each lamp of the place keeps
  std::optional<double> failing = {};  ///< share of those lamps that flicker
  std::optional<double> clutter = {};  ///< of the generated place, 0 bare … 1
  std::optional<int> people = {};      ///< who walk about
  std::optional<double> people_speed = {};  ///< [m/s]
  SourceLoc loc = {};
};

}  // namespace gloam
