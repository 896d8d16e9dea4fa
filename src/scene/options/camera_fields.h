#pragma once
// Fields of [[camera]], its lens, [[stereo]] and [[rgbd]]. A part of
// scene/options/option_fields.h.

#include "gloam/output_names.h"
#include "gloam/scene/camera.h"
#include "gloam/scene/sensor.h"
#include "scene/options/field_rule.h"
#include "scene/options/imager_fields.h"

namespace gloam {

/// Fields that cameras and rigs have in common: place, view, rate.
template <class Visitor, class Options>
void visit_view(Visitor& v, Options& o) {
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("look_at", o.look_at, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", o.orientation, FieldRule{.unit = "wxyz"});
  v("fovy", o.fovy, FieldRule{.unit = "deg", .min = 0, .max = 180, .open = true});
  v("width", o.width, FieldRule{.unit = "px", .min = 1, .max = 16384});
  v("height", o.height, FieldRule{.unit = "px", .min = 1, .max = 16384});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
}

template <class Visitor>
void visit_fields(Visitor& v, LensOptions& o) {
  const FieldRule pixels{.unit = "px", .min = 0, .max = 1e6, .open = true};
  const FieldRule length{.unit = "m", .min = 0, .max = 1, .open = true};
  v("model", o.model,
    FieldRule{.required = true,
              .choices = {"pinhole", "plumb_bob", "rational_polynomial", "equidistant",
                          "equirectangular"}});
  v("d", o.d, FieldRule{.min = -1e6, .max = 1e6});
  v("fx", o.fx, pixels);
  v("fy", o.fy, pixels);
  v("cx", o.cx, FieldRule{.unit = "px", .min = -1e6, .max = 1e6});
  v("cy", o.cy, FieldRule{.unit = "px", .min = -1e6, .max = 1e6});
  v("focal_length", o.focal_length, length);
  v("sensor_size", o.sensor_size, length);
  v("f_number", o.f_number, FieldRule{.min = 0.1, .max = 1000});
  v("focus_distance", o.focus_distance,
    FieldRule{.unit = "m", .min = 0, .max = kLargestLength, .open = true});
}

template <class Visitor>
void visit_fields(Visitor& v, CameraOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("body", o.body, FieldRule{});
  v("track", o.track, FieldRule{});
  visit_view(v, o);
  v("lens", o.lens, FieldRule{});
  v("exposure_time", o.exposure_time, FieldRule{.unit = "s", .min = 0, .max = 100});
  v("readout_time", o.readout_time, FieldRule{.unit = "s", .min = 0, .max = 100});
  v("outputs", o.outputs, FieldRule{.choices = words(kCameraOutputNames)});
  v("near", o.near, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("hide", o.hide, FieldRule{});
  visit_sensing(v, o.sensing);
}

template <class Visitor>
void visit_rig(Visitor& v, RigOptions& o) {
  v("name", o.name, FieldRule{.required = true});  // ROBOT/SENSOR from a catalogue's robot
  v("body", o.body, FieldRule{});
  visit_view(v, o);
}

template <class Visitor>
void visit_fields(Visitor& v, StereoOptions& o) {
  visit_rig(v, o);
  v("baseline", o.baseline, FieldRule{.unit = "m", .min = 0, .max = 100, .open = true});
  visit_sensing(v, o.sensing);
}

template <class Visitor>
void visit_fields(Visitor& v, RgbdOptions& o) {
  visit_rig(v, o);
  v("depth", o.depth, FieldRule{});
  v("color_offset", o.color_offset, FieldRule{.unit = "m", .min = -10, .max = 10});
  v("color_fovy", o.color_fovy, FieldRule{.unit = "deg", .min = 0, .max = 180, .open = true});
  v("imager", o.sensing.imager, FieldRule{});
  v("timing", o.sensing.timing, FieldRule{});
}

}  // namespace gloam
