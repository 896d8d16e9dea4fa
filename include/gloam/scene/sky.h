#pragma once
// Sky and weather of a scene: [sky] (docs/light.md), [weather] and [adversity] (docs/weather.md).
// Part of gloam/scene.h.

#include <filesystem>
#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// A day of the Gregorian calendar.
struct CalendarDate {
  int year = 2000, month = 1, day = 1;  ///< 1900 … 2100, 1 … 12, 1 … last day of the month
  bool operator==(const CalendarDate&) const = default;
};
/// A time of a local clock.
struct ClockTime {
  int hour = 12, minute = 0;  ///< 0 … 23, 0 … 59
  double second = 0;          ///< 0 <= second < 60
  bool operator==(const ClockTime&) const = default;
};

/// [sky]: distant light, one of: an image (`file`), a uniform sky (`luminance`), or a clear sky
/// with the sun, by date and place or by the sun's position. It replaces MuJoCo's skybox, image
/// lights, ambient light and headlight.
struct SkyOptions {
  std::filesystem::path file = {};   ///< equirectangular HDR or EXR; its middle faces +X
  std::optional<double> scale = {};  ///< file: [cd/m²] for a value of one; 1
  std::optional<double> illuminance =
      {};                           ///< file: illuminance of level ground [lx], instead of `scale`
  std::optional<double> turn = {};  ///< file: rotation, counter-clockwise from above [deg]; 0

  std::optional<double> luminance = {};  ///< uniform sky [cd/m²]
  std::optional<Vec3> color = {};        ///< uniform sky: linear Rec. 709, hue only

  std::optional<CalendarDate> date = {};  ///< 2026-06-21
  std::optional<ClockTime> time = {};     ///< local time of day: 14:30:00
  std::optional<double> utc_offset = {};  ///< offset of the clock from UTC, east positive [h]; 0
  std::optional<double> speed =
      {};  ///< speed of the clock, in clock seconds per simulated second; 0 = stopped
  std::optional<double> latitude = {};       ///< north positive [deg]
  std::optional<double> longitude = {};      ///< east positive [deg]
  std::optional<double> sun_elevation = {};  ///< instead of date and place [deg]
  std::optional<double> sun_azimuth = {};  ///< azimuth of the sun, clockwise from north [deg]; 180
  std::optional<double> turbidity = {};    ///< 1 … 10; 2 very clear, 3 clear, 6 hazy; 3
  std::optional<double> ground_albedo = {};  ///< 0 … 1; 0.2
  std::optional<double> altitude = {};       ///< above sea level [m]; 0
  std::optional<double> north = {};  ///< angle of true north from +Y, counter-clockwise [deg]; 0
  SourceLoc loc = {};
};

/// [weather]: weather in numbers. Omitted values follow from the level of [adversity]; without one
/// the weather is fair. Rain and snow fall where the sky is open above.
struct WeatherOptions {
  std::optional<double> rain = {};  ///< [mm/h], default 0
  std::optional<double> snow = {};  ///< rate of snow as water [mm/h], default 0
  std::optional<double> visibility =
      {};  ///< visibility through the medium in the air, by Koschmieder [m]; without rain and snow;
           ///< default: clear
  /// Medium in the air, as in [[volume]]: fog (default) mist haze dust smoke.
  std::optional<std::string> medium = {};
  std::optional<std::string> where = {};  ///< place of the medium: everywhere (default) | rooms
                                          ///< (only in rooms of a generated building)
  double base = 0;          ///< reference z for the heights of the weather, normally the ground [m]
  double height = 15;       ///< height of a uniform medium above `base` [m]
  double scale_height = 0;  ///< height above `base` over which the density falls to 1/e [m]; 0 =
                            ///< uniform. Below `base` the density is constant
  double turbulence = 0;    ///< turbulence of the density: standard deviation over mean, 0 … 1
  std::optional<double> wind = {};  ///< mean speed 10 m above the ground [m/s], default 0
  double wind_from = 270;  ///< direction from which it blows, like the azimuth of [sky] [deg]
  /// Standard deviation of the wind speed over its mean, default 0.15.
  std::optional<double> gusts = {};
  std::optional<double> wetness = {};  ///< initial wetness of surfaces under the open sky, 0 … 1;
                                       ///< default: the level that the rain sustains
  std::optional<double> snow_cover = {};  ///< initial depth of snow on them [m], default 0
  /// Fraction of the cameras' front glass covered by drops, default 0.
  std::optional<double> lens_drops = {};
  SourceLoc loc = {};
};

/// [adversity]: a level, whose values are listed in docs/weather.md, and values that have no other
/// table.
struct AdversityOptions {
  std::string level = "none";               ///< none | minor | major
  std::optional<double> light = {};         ///< fraction of light that each lamp of the place keeps
  std::optional<double> failing = {};       ///< fraction of those lamps that flicker
  std::optional<double> clutter = {};       ///< clutter of the generated place, 0 bare … 1
  std::optional<int> people = {};           ///< number of walking people
  std::optional<double> people_speed = {};  ///< [m/s]
  SourceLoc loc = {};
};

}  // namespace gloam
