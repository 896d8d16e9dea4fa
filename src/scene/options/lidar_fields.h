#pragma once
// The fields of [[lidar]]: a part of scene/options/option_fields.h.

#include "scene/options/field_rule.h"
#include "scene/options/lidar_names.h"
#include "scene/options/pattern_names.h"

namespace gloam {

template <class Visitor>
void visit_fields(Visitor& v, LidarSurfaceOptions& o) {
  v("material", o.material, FieldRule{.required = true});
  v("diffuse", o.diffuse, kShare);
  v("retro", o.retro, FieldRule{.unit = "cd/(lx m²)", .min = 0, .max = 1e4});
}

template <class Visitor>
void visit_fields(Visitor& v, LidarOptions& o) {
  const FieldRule range{.unit = "m", .min = 0, .max = kLargestLength};
  v("name", o.name, FieldRule{.required = true});
  v("body", o.body, FieldRule{});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", o.orientation, FieldRule{.unit = "wxyz"});
  v("preset", o.preset, FieldRule{.choices = words(kLidarPresets)});
  v("pattern", o.pattern, FieldRule{.choices = words(kLidarPatterns)});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
  v("elevations", o.elevations, FieldRule{.unit = "deg", .min = -90, .max = 90});
  v("columns", o.columns, FieldRule{.min = 1, .max = 65535});
  v("rows", o.rows, FieldRule{.min = 1, .max = 4096});
  v("points", o.points, FieldRule{.min = 1, .max = 1 << 24});
  v("azimuth", o.azimuth, FieldRule{.unit = "deg", .min = -180, .max = 180});
  v("field_of_view", o.field_of_view, FieldRule{.unit = "deg", .min = 0.01, .max = 170});
  v("clockwise", o.clockwise, FieldRule{});
  v("wavelength", o.wavelength, FieldRule{.unit = "nm", .min = 800, .max = 1600});
  v("min_range", o.min_range, range);
  v("max_range", o.max_range, range);
  v("range_at_10_percent", o.range_at_10_percent, range);
  v("divergence", o.divergence, FieldRule{.unit = "deg", .min = 0, .max = 60});
  v("beam_size", o.beam_size, FieldRule{.unit = "m", .min = 0, .max = 1});
  v("receiver_diameter", o.receiver_diameter, FieldRule{.unit = "m", .min = 0, .max = 1});
  v("receiver_offset", o.receiver_offset, FieldRule{.unit = "m", .min = 0, .max = 1});
  v("receiver_view", o.receiver_view, FieldRule{.unit = "deg", .min = 1e-3, .max = 180});
  v("pulse_length", o.pulse_length, FieldRule{.unit = "m", .min = 1e-3, .max = 100});
  v("footprint_rays", o.footprint_rays, FieldRule{.min = 1, .max = 32});
  v("returns", o.returns, FieldRule{.choices = words(kLidarReturns)});
  v("most_returns", o.most_returns, FieldRule{.min = 1, .max = 5});
  v("hide", o.hide, FieldRule{});
  v("surface", o.surfaces, FieldRule{});
  v("noise", o.noise, FieldRule{});
  v("range_noise", o.range_noise, FieldRule{.unit = "m", .min = 0, .max = 10});
  v("motion_keys", o.motion_keys, FieldRule{.min = 1, .max = 64});
  v("deskew", o.deskew, FieldRule{});
  v("truth", o.truth, FieldRule{});
  v("intensity", o.intensity, FieldRule{.choices = {"reflectivity", "signal"}});
  v("outputs", o.outputs, FieldRule{.choices = {"pcd", "ply", "npy"}});
}

}  // namespace gloam
