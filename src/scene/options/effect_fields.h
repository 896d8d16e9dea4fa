#pragma once
// The fields of [[gas]], [[fire]], [[smoke]], [[rotor]] and [[dust]]: a part of
// scene/options/option_fields.h.

#include <array>

#include "scene/options/field_rule.h"

namespace gloam {

inline constexpr std::array<std::string_view, 6> kFuels = {
    "propane", "heptane", "wood", "pmma", "polyurethane", "polystyrene"};
inline constexpr std::array<std::string_view, 5> kFireGrowths = {"instant", "slow", "medium",
                                                                 "fast", "ultrafast"};
inline constexpr std::array<std::string_view, 6> kBoxSides = {"-x", "+x", "-y", "+y", "-z", "+z"};

template <class Visitor>
void visit_fields(Visitor& v, GasOptions& o) {
  const FieldRule share{.unit = "1/s", .min = 0, .max = 100};
  v("name", o.name, FieldRule{.required = true});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("size", o.size, FieldRule{.unit = "m", .min = 0.01, .max = 1e4});
  v("voxel", o.voxel, FieldRule{.unit = "m", .min = 1e-3, .max = 10});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0.5, .max = 1000});
  v("medium", o.medium, FieldRule{});
  v("fuel", o.fuel, FieldRule{.choices = words(kFuels)});
  v("temperature", o.temperature, FieldRule{.unit = "K", .min = 150, .max = 600});
  v("wind", o.wind, FieldRule{.unit = "m/s", .min = -100, .max = 100});
  v("closed", o.closed, FieldRule{.choices = words(kBoxSides)});
  v("vorticity", o.vorticity, kShare);
  v("cooling", o.cooling, share);
  v("settling", o.settling, share);
}

template <class Visitor, class Source>
void visit_source(Visitor& v, Source& o) {
  v("name", o.name, FieldRule{.required = true});
  v("body", o.body, FieldRule{});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("size", o.size, FieldRule{.unit = "m", .min = 1e-3, .max = 1000});
  v("start", o.start, FieldRule{.unit = "s", .min = 0, .max = kLongestTime});
  v("stop", o.stop, FieldRule{.unit = "s", .min = 0, .max = kLongestTime});
}

template <class Visitor>
void visit_fields(Visitor& v, FireOptions& o) {
  visit_source(v, o);
  v("power", o.power, FieldRule{.unit = "W", .min = 0, .max = 1e9});
  v("growth", o.growth, FieldRule{.choices = words(kFireGrowths)});
}

template <class Visitor>
void visit_fields(Visitor& v, SmokeOptions& o) {
  visit_source(v, o);
  v("rate", o.rate, FieldRule{.unit = "kg/s", .min = 0, .max = 1000});
  v("heat", o.heat, FieldRule{.unit = "W", .min = 0, .max = 1e9});
  v("velocity", o.velocity, FieldRule{.unit = "m/s", .min = -100, .max = 100});
}

template <class Visitor>
void visit_fields(Visitor& v, RotorOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("actuator", o.actuator, FieldRule{});
  v("site", o.site, FieldRule{});
  v("thrust", o.thrust, FieldRule{.unit = "N", .min = -1e5, .max = 1e5});
  v("radius", o.radius, FieldRule{.unit = "m", .min = 1e-3, .max = 50, .required = true});
}

template <class Visitor>
void visit_fields(Visitor& v, DustOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("size", o.size, FieldRule{.unit = "m", .min = 1e-3, .max = 1e4});
  v("silt", o.silt, kShare);
  v("clay", o.clay, FieldRule{.min = 0, .max = 0.2});
  v("threshold", o.threshold, FieldRule{.unit = "m/s", .min = 0.05, .max = 10});
}

}  // namespace gloam
