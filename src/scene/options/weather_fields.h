#pragma once
// The fields of [weather], [adversity], [[water]] and [[soil]]: a part of
// scene/options/option_fields.h.

#include <array>

#include "scene/options/field_rule.h"

namespace gloam {

inline constexpr std::array<std::string_view, 3> kAdversityLevels = {"none", "minor", "major"};
inline constexpr std::array<std::string_view, 2> kWeatherPlaces = {"everywhere", "rooms"};
inline constexpr std::array<std::string_view, 7> kSoilKinds = {
    "dry_sand", "sandy_loam", "clayey_soil", "lean_clay", "snow", "mud", "lunar"};

template <class Visitor>
void visit_fields(Visitor& v, WeatherOptions& o) {
  v("rain", o.rain, FieldRule{.unit = "mm/h", .min = 0, .max = 300});
  v("snow", o.snow, FieldRule{.unit = "mm/h", .min = 0, .max = 50});
  v("visibility", o.visibility, FieldRule{.unit = "m", .min = 0, .max = 1e6, .open = true});
  v("medium", o.medium, FieldRule{});
  v("where", o.where, FieldRule{.choices = words(kWeatherPlaces)});
  v("base", o.base, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("height", o.height, FieldRule{.unit = "m", .min = 0, .max = 1e4, .open = true});
  v("scale_height", o.scale_height, FieldRule{.unit = "m", .min = 0, .max = 1e4});
  v("turbulence", o.turbulence, kShare);
  v("wind", o.wind, FieldRule{.unit = "m/s", .min = 0, .max = 60});
  v("wind_from", o.wind_from, FieldRule{.unit = "deg", .min = -360, .max = 360});
  v("gusts", o.gusts, kShare);
  v("wetness", o.wetness, kShare);
  v("snow_cover", o.snow_cover, FieldRule{.unit = "m", .min = 0, .max = 2});
  v("lens_drops", o.lens_drops, kShare);
}

template <class Visitor>
void visit_fields(Visitor& v, AdversityOptions& o) {
  v("level", o.level, FieldRule{.choices = words(kAdversityLevels)});
  v("light", o.light, kShare);
  v("failing", o.failing, kShare);
  v("clutter", o.clutter, kShare);
  v("people", o.people, FieldRule{.min = 0, .max = 200});
  v("people_speed", o.people_speed, FieldRule{.unit = "m/s", .min = 0, .max = 3, .open = true});
}

template <class Visitor>
void visit_fields(Visitor& v, WaterOptions& o) {
  const FieldRule angle{.unit = "deg", .min = -360, .max = 360};
  v("name", o.name, FieldRule{.required = true});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("size", o.size, FieldRule{.unit = "m", .min = 0.05, .max = 1000});
  v("depth", o.depth, FieldRule{.unit = "m", .min = 0.01, .max = 1000});
  v("wave_height", o.wave_height, FieldRule{.unit = "m", .min = 0, .max = 10});
  v("wave_period", o.wave_period, FieldRule{.unit = "s", .min = 0.2, .max = 20});
  v("wave_to", o.wave_to, angle);
  v("spread", o.spread, FieldRule{.unit = "deg", .min = 0, .max = 90});
  v("density", o.density, FieldRule{.unit = "kg/m3", .min = 1, .max = 2e4});
  v("viscosity", o.viscosity, FieldRule{.unit = "Pa s", .min = 1e-6, .max = 1e3});
  v("current", o.current, FieldRule{.unit = "m/s", .min = -10, .max = 10});
  v("clarity", o.clarity, FieldRule{.unit = "m", .min = 0.01, .max = 100});
  v("ripples", o.ripples, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, SoilOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("size", o.size, FieldRule{.unit = "m", .min = 0.1, .max = 200});
  v("depth", o.depth, FieldRule{.unit = "m", .min = 0.005, .max = 5});
  v("over_ground", o.over_ground, FieldRule{});
  v("cell", o.cell, FieldRule{.unit = "m", .min = 0.002, .max = 0.5});
  v("kind", o.kind, FieldRule{.choices = words(kSoilKinds)});
  v("n", o.n, FieldRule{.min = 0.1, .max = 3});
  v("k_c", o.k_c, FieldRule{.unit = "N/m^(n+1)", .min = 0, .max = 1e9});
  v("k_phi", o.k_phi, FieldRule{.unit = "N/m^(n+2)", .min = 0, .max = 1e10});
  v("cohesion", o.cohesion, FieldRule{.unit = "Pa", .min = 0, .max = 1e7});
  v("friction", o.friction, FieldRule{.unit = "deg", .min = 0, .max = 60});
  v("shear", o.shear, FieldRule{.unit = "m", .min = 1e-4, .max = 1});
  v("k_0", o.k_0, FieldRule{.unit = "N/m3", .min = 0, .max = 1e11});
  v("a_u", o.a_u, FieldRule{.unit = "N/m4", .min = 0, .max = 1e12});
}

}  // namespace gloam
