#pragma once
// The fields of [[light]], [sky] and [[volume]]: a part of scene/options/option_fields.h.

#include "scene/options/field_rule.h"

namespace gloam {

inline constexpr double kSmallestLength = 1e-6;  // [m]
inline constexpr double kBrightest = 1e12;       // [cd], [lm], [cd/m²], [lx]: the sun has 1.6e9

template <class Visitor>
void visit_fields(Visitor& v, OnOffOptions& o) {
  v("period", o.period, FieldRule{.unit = "s", .min = 1e-6, .max = kLongestTime});
  v("duty", o.duty, kShare);
  v("phase", o.phase, kShare);
}

template <class Visitor>
void visit_fields(Visitor& v, LightKeyOptions& o) {
  v("time", o.time, FieldRule{.unit = "s", .min = 0, .max = kLongestTime, .required = true});
  v("level", o.level, FieldRule{.min = 0, .max = 1e6, .required = true});
}

template <class Visitor>
void visit_fields(Visitor& v, MainsOptions& o) {
  v("frequency", o.frequency, FieldRule{.unit = "Hz", .min = 1e-6, .max = kFastestRate});
  v("depth", o.depth, kShare);
}

template <class Visitor>
void visit_fields(Visitor& v, StarterOptions& o) {
  v("at", o.at, FieldRule{.unit = "s", .min = 0, .max = kLongestTime});
  v("warm_up", o.warm_up, FieldRule{.unit = "s", .min = 1e-6, .max = kLongestTime});
}

template <class Visitor>
void visit_fields(Visitor& v, FlameOptions& o) {
  v("bandwidth", o.bandwidth, FieldRule{.unit = "Hz", .min = 1e-6, .max = kFastestRate});
  v("depth", o.depth, kShare);
}

template <class Visitor>
void visit_fields(Visitor& v, LightScheduleOptions& o) {
  v("on_off", o.on_off, FieldRule{});
  v("keys", o.keys, FieldRule{});
  v("hold", o.hold, FieldRule{});
  v("mains", o.mains, FieldRule{});
  v("starter", o.starter, FieldRule{});
  v("flame", o.flame, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, LightMotionOptions& o) {
  v("spin", o.spin, FieldRule{.unit = "rev/min", .min = -1e5, .max = 1e5});
  v("sway", o.sway, FieldRule{.unit = "deg", .min = 0, .max = 60});
  v("cord", o.cord, FieldRule{.unit = "m", .min = 0.01, .max = 100});
  v("axis", o.axis, FieldRule{.min = -1e6, .max = 1e6});
  v("phase", o.phase, kShare);
}

template <class Visitor>
void visit_fields(Visitor& v, BlackoutOptions& o) {
  v("at", o.at, FieldRule{.unit = "s", .min = 0, .max = kLongestTime, .required = true});
  v("until", o.until, FieldRule{.unit = "s", .min = 0, .max = kLongestTime});
  v("starter", o.starter, FieldRule{});
  v("except", o.except, FieldRule{});
  v("emergency", o.emergency, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, LightOptions& o) {
  const FieldRule place{.unit = "m", .min = -kLargestLength, .max = kLargestLength};
  const FieldRule length{.unit = "m", .min = kSmallestLength, .max = kLargestLength};
  v("name", o.name, FieldRule{.required = true});
  v("type", o.type, FieldRule{.required = true, .choices = words<LightType>()});
  v("body", o.body, FieldRule{});
  v("position", o.position, place);
  v("look_at", o.look_at, place);
  v("orientation", o.orientation, FieldRule{.unit = "wxyz"});
  v("intensity", o.intensity, FieldRule{.unit = "cd", .min = 0, .max = kBrightest});
  v("flux", o.flux, FieldRule{.unit = "lm", .min = 0, .max = kBrightest});
  v("luminance", o.luminance, FieldRule{.unit = "cd/m²", .min = 0, .max = kBrightest});
  v("illuminance", o.illuminance, FieldRule{.unit = "lx", .min = 0, .max = kBrightest});
  v("color", o.color, kShare);
  v("temperature", o.temperature, FieldRule{.unit = "K", .min = 1000, .max = 20000});
  v("size", o.size, length);
  v("radius", o.radius, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("angle", o.angle, FieldRule{.unit = "deg", .min = 0, .max = 180});
  v("softness", o.softness, kShare);
  v("file", o.file, FieldRule{});
  v("ies", o.ies, FieldRule{});
  v("casts_shadow", o.casts_shadow, FieldRule{});
  v("motion", o.motion, FieldRule{});
  v("schedule", o.schedule, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, SkyOptions& o) {
  const FieldRule angle{.unit = "deg", .min = -360, .max = 360};
  v("file", o.file, FieldRule{});
  v("scale", o.scale, FieldRule{.unit = "cd/m²", .min = 0, .max = kBrightest});
  v("illuminance", o.illuminance, FieldRule{.unit = "lx", .min = 0, .max = kBrightest});
  v("turn", o.turn, angle);
  v("luminance", o.luminance, FieldRule{.unit = "cd/m²", .min = 0, .max = kBrightest});
  v("color", o.color, kShare);
  v("date", o.date, FieldRule{});
  v("time", o.time, FieldRule{});
  v("utc_offset", o.utc_offset, FieldRule{.unit = "h", .min = -14, .max = 14});
  v("speed", o.speed, FieldRule{.unit = "s/s", .min = 0, .max = 1e6});
  v("latitude", o.latitude, FieldRule{.unit = "deg", .min = -90, .max = 90});
  v("longitude", o.longitude, FieldRule{.unit = "deg", .min = -180, .max = 180});
  v("sun_elevation", o.sun_elevation, FieldRule{.unit = "deg", .min = -90, .max = 90});
  v("sun_azimuth", o.sun_azimuth, angle);
  v("turbidity", o.turbidity, FieldRule{.min = 1, .max = 10});
  v("ground_albedo", o.ground_albedo, kShare);
  v("altitude", o.altitude, FieldRule{.unit = "m", .min = 0, .max = 9000});
  v("north", o.north, angle);
}

template <class Visitor>
void visit_fields(Visitor& v, VolumePatternOptions& o) {
  v("kind", o.kind, FieldRule{.required = true, .choices = {"plume", "cloud"}});
  v("seed", o.seed, FieldRule{.max = 4294967295.0});
  v("resolution", o.resolution, FieldRule{.min = 8, .max = 256});
}

template <class Visitor>
void visit_fields(Visitor& v, VolumeOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", o.orientation, FieldRule{.unit = "wxyz"});
  v("size", o.size,
    FieldRule{.unit = "m", .min = kSmallestLength, .max = kLargestLength, .required = true});
  v("medium", o.medium, FieldRule{});
  v("mass_extinction", o.mass_extinction, FieldRule{.unit = "m²/kg", .min = 0, .max = 1e9});
  v("albedo", o.albedo, kShare);
  v("g", o.g, FieldRule{.min = -1, .max = 1, .open = true});
  v("density", o.density, FieldRule{.unit = "kg/m³", .min = 0, .max = 1e5});
  v("visibility", o.visibility, FieldRule{.unit = "m", .min = 1e-4, .max = kLargestLength});
  v("temperature", o.temperature, FieldRule{.unit = "K", .min = 0, .max = 1e5});
  v("emission", o.emission, FieldRule{.min = 0, .max = 1e6});
  v("fade", o.fade, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("grid", o.grid, FieldRule{});
  v("temperature_grid", o.temperature_grid, FieldRule{});
  v("pattern", o.pattern, FieldRule{});
}

}  // namespace gloam
