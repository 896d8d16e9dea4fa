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
  int year = 2000, month = 1, day = 1;  ///< 1900 … 2100, 1 … 12, 1 … the month's last
  bool operator==(const CalendarDate&) const = default;
};
/// A time of a local clock.
struct ClockTime {
  int hour = 12, minute = 0;  ///< 0 … 23, 0 … 59
  double second = 0;          ///< 0 <= second < 60
  bool operator==(const ClockTime&) const = default;
};

/// [sky]: light from far away, one of: a picture (`file`), an even sky (`luminance`), or a clear
/// sky with its sun, by date and place or by the sun's position. It takes the place of MuJoCo's
/// skybox, image lights, ambient light and headlight.
struct SkyOptions {
  std::filesystem::path file = {};         ///< equirectangular HDR or EXR; its middle faces +X
  std::optional<double> scale = {};        ///< file: [cd/m²] of a value of one; 1
  std::optional<double> illuminance = {};  ///< file: instead of `scale`, of level ground [lx]
  std::optional<double> turn = {};         ///< file: counter-clockwise from above [deg]; 0

  std::optional<double> luminance = {};  ///< even [cd/m²]
  std::optional<Vec3> color = {};        ///< even: linear Rec. 709, hue only

  std::optional<CalendarDate> date = {};  ///< 2026-06-21
  std::optional<ClockTime> time = {};     ///< time of day, by the clock there: 14:30:00
  std::optional<double> utc_offset = {};  ///< offset of the clock from UTC, east positive [h]; 0
  std::optional<double> speed = {};      ///< speed of the clock, in seconds of it per second of the
                                         ///< simulation; 0 = it stands still
  std::optional<double> latitude = {};   ///< north positive [deg]
  std::optional<double> longitude = {};  ///< east positive [deg]
  std::optional<double> sun_elevation = {};  ///< instead of date and place [deg]
  std::optional<double> sun_azimuth = {};    ///< its azimuth, clockwise from north [deg]; 180
  std::optional<double> turbidity = {};      ///< 1 … 10; 2 very clear, 3 clear, 6 hazy; 3
  std::optional<double> ground_albedo = {};  ///< 0 … 1; 0.2
  std::optional<double> altitude = {};       ///< above sea level [m]; 0
  std::optional<double> north = {};  ///< angle of true north from +Y, counter-clockwise [deg]; 0
  SourceLoc loc = {};
};

/// [weather]: in numbers. What is not given is what the level of [adversity] says, and without one
/// fair. Rain and snow fall where the sky is open above.
struct WeatherOptions {
  std::optional<double> rain = {};        ///< [mm/h], default 0
  std::optional<double> snow = {};        ///< rate of snow as water [mm/h], default 0
  std::optional<double> visibility = {};  ///< through what hangs in the air, by Koschmieder [m];
                                          ///< without rain and snow; default: clear
  /// Medium in the air, as in [[volume]]: fog (default) mist haze dust smoke.
  std::optional<std::string> medium = {};
  std::optional<std::string> where = {};  ///< place of the medium: everywhere (default) | rooms,
                                          ///< only those of a generated building
  double base = 0;          ///< z from which the weather's heights count [m]: that of the ground
  double height = 15;       ///< up to which the medium hangs above `base`, if it is even [m]
  double scale_height = 0;  ///< height above `base` over which it thins to 1/e [m]; 0 = even. Below
                            ///< `base` it is as dense as there
  double turbulence = 0;    ///< turbulence of its density: standard deviation over mean, 0 … 1
  std::optional<double> wind = {};  ///< mean speed 10 m above the ground [m/s], default 0
  double wind_from = 270;           ///< direction it comes from, as [sky]'s azimuth [deg]
  /// Standard deviation of its speed over the mean, default 0.15.
  std::optional<double> gusts = {};
  std::optional<double> wetness = {};  ///< wetness of surfaces under the open sky at the start, 0 …
                                       ///< 1; default: the level that the rain sustains
  std::optional<double> snow_cover = {};  ///< depth of snow on them at the start [m], default 0
  /// Fraction of cameras' front glass under drops, default 0.
  std::optional<double> lens_drops = {};
  SourceLoc loc = {};
};

/// [adversity]: a level, for which docs/weather.md has the numbers, and its numbers that stand
/// nowhere else.
struct AdversityOptions {
  std::string level = "none";          ///< none | minor | major
  std::optional<double> light = {};    ///< fraction of its light that each lamp of the place keeps
  std::optional<double> failing = {};  ///< fraction of those lamps that flicker
  std::optional<double> clutter = {};  ///< clutter of the generated place, 0 bare … 1
  std::optional<int> people = {};      ///< number of people who walk about
  std::optional<double> people_speed = {};  ///< [m/s]
  SourceLoc loc = {};
};

}  // namespace gloam
