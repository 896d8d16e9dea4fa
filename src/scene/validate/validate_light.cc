#include "scene/validate/validate_light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "scene/options/option_fields.h"

namespace gloam {
namespace {

using Keys = std::vector<std::string_view>;

bool holds(const Keys& keys, std::string_view key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Keys of one option struct that were given: optionals with a value, and text or lists that are
/// not empty.
class GivenKeys {
 public:
  template <class T>
  void operator()(std::string_view key, const T& member, const FieldRule&) {
    bool given = false;
    if constexpr (requires { member.has_value(); })
      given = member.has_value();
    else if constexpr (requires { member.empty(); })
      given = !member.empty();
    if (given) keys.push_back(key);
  }
  Keys keys;
};

template <class Options>
Keys given_keys(const Options& options) {
  GivenKeys given;
  visit_fields(given, const_cast<Options&>(options));  // visitors that read do not write
  return std::move(given.keys);
}

/// One kind of an element: its optional keys, besides the keys of all kinds, and its required keys.
struct Kind {
  Keys may, must;
};

/// `what` is the whole subject of the message, "light 'x' of type rect".
Status check_kind(const Kind& kind, const Keys& all, const Keys& given, const std::string& what,
                  const SourceLoc& loc) {
  for (const std::string_view key : given) {
    if (holds(all, key) || holds(kind.may, key) || holds(kind.must, key)) continue;
    Keys usable = kind.must;
    usable.insert(usable.end(), kind.may.begin(), kind.may.end());
    return Error{ErrorKind::kInput, fmt::format("{} does not support '{}'", what, key), loc,
                 fmt::format("it supports {}", fmt::join(usable, ", "))};
  }
  for (const std::string_view key : kind.must) {
    if (holds(given, key)) continue;
    return Error{ErrorKind::kInput, fmt::format("{} needs '{}'", what, key), loc};
  }
  return {};
}

const Keys kEveryLight = {"name",  "type",        "body",   "look_at", "orientation",
                          "color", "temperature", "motion", "schedule"};
const Keys kStrengths = {"intensity", "flux", "luminance", "illuminance"};

Kind kind_of(LightType type) {
  switch (type) {
    case LightType::kPoint:
      return {{"intensity", "flux", "luminance", "radius", "ies"}, {}};
    case LightType::kSpot:
      return {{"intensity", "flux", "luminance", "radius", "ies", "angle", "softness"}, {}};
    case LightType::kDirectional:
      return {{"angle"}, {"illuminance"}};
    case LightType::kRect:
      return {{"luminance", "flux", "intensity"}, {"size"}};
    case LightType::kDisk:
    case LightType::kSphere:
      return {{"luminance", "flux", "intensity"}, {"radius"}};
    case LightType::kMesh:
      return {{"luminance", "flux"}, {"file"}};
  }
  return {};
}

bool is_area(const LightOptions& light) { return light.type && is_area_light(*light.type); }

Status check_strength(const LightOptions& light, const Keys& given, const std::string& what) {
  const auto error = [&](std::string message, std::string hint = {}) {
    return Error{ErrorKind::kInput, std::move(message), light.loc, std::move(hint)};
  };
  Keys strengths;
  for (const std::string_view key : kStrengths) {
    if (holds(given, key)) strengths.push_back(key);
  }
  if (strengths.size() > 1) {
    return error(fmt::format("{} has both '{}' and '{}'", what, strengths[0], strengths[1]),
                 "specify only one of them");
  }
  if (strengths.empty() && light.ies.empty()) {
    return error(fmt::format("{} has no strength", what),
                 "specify 'intensity' [cd], 'flux' [lm] or 'luminance' [cd/m²]");
  }
  if (light.luminance && !is_area(light)) {
    if (!light.ies.empty()) {
      return error(fmt::format("{} has both 'luminance' and 'ies'", what),
                   "specify 'intensity' or 'flux', or use the strength from the file");
    }
    if (light.radius.value_or(0) <= 0) {
      return error(fmt::format("{} has a luminance but no radius", what),
                   "specify 'radius', or its strength as 'intensity' or 'flux'");
    }
  }
  return {};
}

Status check_pose(const LightOptions& light, const std::string& what) {
  if (light.look_at && light.orientation) {
    return Error{ErrorKind::kInput, fmt::format("{} has both 'look_at' and 'orientation'", what),
                 light.loc, "specify only one of them"};
  }
  if (light.look_at && *light.look_at == light.position) {
    return Error{ErrorKind::kInput, fmt::format("{} points at its own position", what), light.loc,
                 "change 'look_at' or 'position'"};
  }
  return {};
}

Status check_motion(const LightMotionOptions& motion, const std::string& what,
                    const SourceLoc& loc) {
  const auto error = [&](std::string_view problem, std::string hint) {
    return Error{ErrorKind::kInput, fmt::format("the motion of {} {}", what, problem), loc,
                 std::move(hint)};
  };
  if (motion.spin.has_value() == motion.sway.has_value()) {
    return error(motion.spin ? "has both 'spin' and 'sway'" : "has neither 'spin' nor 'sway'",
                 "specify exactly one of them");
  }
  if (motion.cord && motion.spin)
    return error("has both 'spin' and 'cord'", "'cord' requires 'sway'");
  if (motion.axis == Vec3{}) return error("has an axis of length 0", "up is [0, 0, 1]");
  return {};
}

bool is_black(const std::optional<Vec3>& color) { return color && *color == Vec3{}; }

bool is_day(const CalendarDate& d) {
  using std::chrono::year, std::chrono::month, std::chrono::day;
  if (d.year < 1900 || d.year > 2100 || d.month < 1 || d.day < 1) return false;
  return (year(d.year) / month(static_cast<unsigned>(d.month)) / day(static_cast<unsigned>(d.day)))
      .ok();
}

bool is_clock(const ClockTime& t) {
  return t.hour >= 0 && t.hour < 24 && t.minute >= 0 && t.minute < 60 && t.second >= 0 &&
         t.second < 60;
}

}  // namespace

Status validate_light(const LightOptions& light) {
  const std::string what = fmt::format("light '{}' of type {}", light.name, to_string(light.type));
  const auto error = [&](std::string message, std::string hint = {}) {
    return Error{ErrorKind::kInput, std::move(message), light.loc, std::move(hint)};
  };
  const Keys given = given_keys(light);
  if (light.type)
    GLOAM_TRY_STATUS(check_kind(kind_of(*light.type), kEveryLight, given, what, light.loc));
  GLOAM_TRY_STATUS(check_strength(light, given, what));
  GLOAM_TRY_STATUS(check_pose(light, what));
  if (light.motion) {
    const SourceLoc& own = light.motion->loc;
    GLOAM_TRY_STATUS(check_motion(*light.motion, what, own.file.empty() ? light.loc : own));
  }
  if (light.color && light.temperature)
    return error(fmt::format("{} has both 'color' and 'temperature'", what),
                 "specify only one of them");
  if (is_black(light.color)) {
    return error(fmt::format("{} has the colour black, which has no hue", what),
                 "to turn a lamp off, set its strength to 0");
  }
  if (is_area(light) && light.radius.value_or(1) < kSmallestLength)
    return error(fmt::format("{} has a radius of {} m", what, *light.radius));
  if (is_area(light) && !light.casts_shadow) {
    return error(fmt::format("{} always casts shadows", what),
                 "only point, spot and directional lights can do without");
  }
  if (light.type == LightType::kSpot && light.angle && *light.angle <= 0)
    return error(fmt::format("{} has a cone of 0 degrees", what),
                 "'angle' is the half angle of the cone");
  if (light.type == LightType::kDirectional && light.angle.value_or(0) > 90)
    return error(fmt::format("{} is {} degrees wide; the maximum is 90", what, *light.angle));
  return {};
}

Status validate_sky(const SkyOptions& sky) {
  const auto error = [&](std::string message, std::string hint = {}) {
    return Error{ErrorKind::kInput, std::move(message), sky.loc, std::move(hint)};
  };
  const Keys given = given_keys(sky);
  if (given.empty()) {
    return error("[sky] is empty",
                 "specify 'file', 'luminance', 'sun_elevation', or 'date', 'time', 'latitude' and "
                 "'longitude'");
  }
  if (!sky.file.empty()) {
    if (sky.scale && sky.illuminance)
      return error("[sky] has both 'scale' and 'illuminance'", "specify only one of them");
    return check_kind({{"scale", "illuminance", "turn"}, {"file"}}, {}, given,
                      "a [sky] from a file", sky.loc);
  }
  if (sky.luminance) {
    if (is_black(sky.color)) return error("[sky] has the colour black, which has no hue");
    return check_kind({{"color"}, {"luminance"}}, {}, given, "a uniform [sky]", sky.loc);
  }
  const Keys air = {"turbidity", "ground_albedo", "altitude", "north"};
  if (sky.sun_elevation || sky.sun_azimuth) {
    return check_kind({{"sun_azimuth"}, {"sun_elevation"}}, air, given,
                      "a [sky] with a sun position", sky.loc);
  }
  GLOAM_TRY_STATUS(check_kind({{"utc_offset", "speed"}, {"date", "time", "latitude", "longitude"}},
                              air, given, "a [sky] with date and place", sky.loc));
  if (!is_day(*sky.date)) {
    return error(fmt::format("{:04}-{:02}-{:02} is not a date from 1900 to 2100", sky.date->year,
                             sky.date->month, sky.date->day));
  }
  if (!is_clock(*sky.time)) {
    return error(fmt::format("'time' of [sky] is {:02}:{:02}:{:02}", sky.time->hour,
                             sky.time->minute, sky.time->second),
                 "use a time from 00:00 to 23:59");
  }
  return {};
}

Status validate_blackout(const BlackoutOptions& blackout) {
  if (!blackout.until && blackout.starter) {
    return Error{ErrorKind::kInput, "[blackout] has 'starter', but no lamp turns on again",
                 blackout.loc, "specify 'until', or remove 'starter'"};
  }
  if (blackout.until && *blackout.until <= blackout.at) {
    return Error{
        ErrorKind::kInput,
        fmt::format("[blackout] ends at {} s, but starts at {} s", *blackout.until, blackout.at),
        blackout.loc, "'until' is a time, not a duration"};
  }
  return {};
}

Status validate_volume(const VolumeOptions& volume) {
  const std::string what = fmt::format("volume '{}'", volume.name);
  const auto error = [&](std::string message, std::string hint = {}) {
    return Error{ErrorKind::kInput, what + " " + message, volume.loc, std::move(hint)};
  };
  for (const double edge : {volume.size.x, volume.size.y, volume.size.z}) {
    if (edge < kSmallestLength) return error("has no size", "specify 'size' = [x, y, z] in metres");
  }
  const bool own = !volume.mass_extinction.empty();
  if (own == !volume.medium.empty()) {
    return error(own ? "has both 'medium' and 'mass_extinction'"
                     : "has neither 'medium' nor 'mass_extinction'",
                 "specify exactly one of them");
  }
  if (!own && (!volume.albedo.empty() || !volume.g.empty()))
    return error("has 'medium' together with 'albedo' or 'g'", "use them with 'mass_extinction'");
  for (const auto& [key, numbers] :
       {std::pair{"mass_extinction", &volume.mass_extinction}, std::pair{"albedo", &volume.albedo},
        std::pair{"g", &volume.g}}) {
    constexpr size_t kBands = 6;
    if (numbers->size() <= 1 || numbers->size() == kBands) continue;
    return error(
        fmt::format("has {} numbers in '{}'", numbers->size(), key),
        "use one for all bands, or one each for red, green, blue, 905 nm, 1550 nm, 8-14 µm");
  }
  if (volume.density.has_value() == volume.visibility.has_value()) {
    return error(volume.density ? "has both 'density' and 'visibility'"
                                : "has neither 'density' nor 'visibility'",
                 "specify exactly one of them");
  }
  if (volume.pattern && !volume.grid.empty())
    return error("has both 'grid' and 'pattern'", "specify only one of them");
  if (volume.pattern && !volume.temperature_grid.empty())
    return error("has both 'pattern' and 'temperature_grid'", "specify its density with 'grid'");
  return {};
}

}  // namespace gloam
