#pragma once
// The list of every option a scene file may hold: one line per field (key, member, unit, range).
// The TOML reader, the overrides of the command line and later the schema and the manual all read
// it.
//
// A Visitor is called once per field as visitor(key, member, FieldRule). Where they stand in the
// file is the reader's business: `loc` members are not listed.

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/scene.h"

namespace gloam {

struct FieldRule {
  std::string_view unit = {};  ///< "" = none or text
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open = false;                           ///< min and max themselves are not allowed
  bool required = false;                       ///< must stand in the file
  std::vector<std::string_view> choices = {};  ///< closed list of words; empty = any
  bool identifier = false;  ///< a name: not empty, no '/' and no control characters
};

inline constexpr double kLongestTime = 1e9;    // [s] 30 years
inline constexpr double kLargestLength = 1e6;  // [m]
inline constexpr double kLargestSpeed = 1e4;   // [m/s], [rad/s]
inline constexpr double kFastestRate = 1e6;    // [Hz]

template <class Visitor>
void visit_fields(Visitor& v, VelocityGoal& o) {
  v("time", o.time, FieldRule{.unit = "s", .min = 0, .max = kLongestTime, .required = true});
  v("vx", o.vx, FieldRule{.unit = "m/s", .min = -kLargestSpeed, .max = kLargestSpeed});
  v("vy", o.vy, FieldRule{.unit = "m/s", .min = -kLargestSpeed, .max = kLargestSpeed});
  v("yaw_rate", o.yaw_rate,
    FieldRule{.unit = "rad/s", .min = -kLargestSpeed, .max = kLargestSpeed});
}

template <class Visitor>
void visit_fields(Visitor& v, ControllerOptions& o) {
  v("type", o.type, FieldRule{.choices = {"none", "torque", "joint_position", "trot"}});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
  v("kp", o.kp, FieldRule{.unit = "N m/rad", .min = 0, .max = 1e6});
  v("kd", o.kd, FieldRule{.unit = "N m s/rad", .min = 0, .max = 1e6});
  v("target", o.target, FieldRule{.unit = "rad or N m", .min = -1e6, .max = 1e6});
  v("goals", o.goals, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RobotOptions& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  v("file", o.file, FieldRule{.required = true});
  v("position", o.X_WR.p, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", o.X_WR.q, FieldRule{.unit = "wxyz"});
  v("keyframe", o.keyframe, FieldRule{});
  v("controller", o.controller, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, EnvironmentOptions& o) {
  v("file", o.file, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, CameraOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("body", o.body, FieldRule{});
  v("track", o.track, FieldRule{});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("look_at", o.look_at, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", o.orientation, FieldRule{.unit = "wxyz"});
  v("fovy", o.fovy, FieldRule{.unit = "deg", .min = 0, .max = 180, .open = true});
  v("width", o.width, FieldRule{.unit = "px", .min = 1, .max = 16384});
  v("height", o.height, FieldRule{.unit = "px", .min = 1, .max = 16384});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
  v("outputs", o.outputs,
    FieldRule{.choices = {"video", "png", "depth_png", "depth_exr", "segmentation"}});
}

template <class Visitor>
void visit_fields(Visitor& v, PatternOptions& o) {
  const FieldRule share{.min = 0, .max = 1};
  const FieldRule length{.unit = "m", .min = 1e-5, .max = kLargestLength};
  v("kind", o.kind,
    FieldRule{.required = true,
              .choices = {"noise", "wood", "marble", "concrete", "brick", "tiles", "fabric",
                          "scratches", "dirt"}});
  v("seed", o.seed, FieldRule{.max = 4294967295.0});
  v("color_a", o.color_a, share);
  v("color_b", o.color_b, share);
  v("color_c", o.color_c, share);
  v("scale", o.scale, length);
  v("size_u", o.size_u, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("size_v", o.size_v, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("gap", o.gap, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("depth", o.depth, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("roughness", o.roughness, share);
  v("coat", o.coat, share);
  v("variation", o.variation, share);
  v("amount", o.amount, share);
  v("axis", o.axis, FieldRule{.min = -1, .max = 1});
  v("basis", o.basis, FieldRule{.choices = {"fbm", "turbulence", "ridged", "cells"}});
  v("bond", o.bond, FieldRule{.choices = {"running", "stack", "english"}});
  v("tile", o.tile, FieldRule{.choices = {"square", "hexagon"}});
  v("weave", o.weave, FieldRule{.choices = {"plain", "twill"}});
}

template <class Visitor>
void visit_fields(Visitor& v, MaterialOptions& o) {
  const FieldRule share{.min = 0, .max = 1};
  v("name", o.name, FieldRule{.required = true});
  v("ior", o.ior, FieldRule{.min = 1, .max = 3});
  v("anisotropy", o.anisotropy, share);
  v("anisotropy_rotation", o.anisotropy_rotation, FieldRule{.unit = "turn", .min = -1, .max = 1});
  v("transmission_weight", o.transmission_weight, share);
  v("transmission_color", o.transmission_color, share);
  v("transmission_depth", o.transmission_depth,
    FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("thin_walled", o.thin_walled, FieldRule{});
  v("subsurface_weight", o.subsurface_weight, share);
  v("subsurface_color", o.subsurface_color, share);
  v("coat_weight", o.coat_weight, share);
  v("coat_roughness", o.coat_roughness, share);
  v("coat_ior", o.coat_ior, FieldRule{.min = 1, .max = 3});
  v("coat_color", o.coat_color, share);
  v("fuzz_weight", o.fuzz_weight, share);
  v("fuzz_roughness", o.fuzz_roughness, share);
  v("fuzz_color", o.fuzz_color, share);
  v("pattern", o.pattern, FieldRule{});
  v("wear", o.wear, FieldRule{});
  v("wetness", o.wetness, share);
  v("porosity", o.porosity, share);
  v("dust", o.dust, share);
  v("snow", o.snow, share);
}

template <class Visitor>
void visit_fields(Visitor& v, PushOptions& o) {
  v("body", o.body, FieldRule{.required = true});
  v("time", o.time, FieldRule{.unit = "s", .min = 0, .max = kLongestTime, .required = true});
  v("velocity", o.velocity, FieldRule{.unit = "m/s", .min = -kLargestSpeed, .max = kLargestSpeed});
}

template <class Visitor>
void visit_fields(Visitor& v, SimOptions& o) {
  v("timestep", o.timestep, FieldRule{.unit = "s", .min = 0, .max = 1, .open = true});
  v("duration", o.duration, FieldRule{.unit = "s", .min = 0, .max = kLongestTime, .open = true});
  v("seed", o.seed, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RenderOptions& o) {
  v("tier", o.tier, FieldRule{.choices = {"path", "direct"}});
  v("spp", o.spp, FieldRule{.min = 1, .max = 65536});
  v("error", o.error, FieldRule{.min = 1e-4, .max = 1});
  v("max_depth", o.max_depth, FieldRule{.min = 1, .max = 64});
  v("denoise", o.denoise, FieldRule{});
  v("ev100", o.ev100, FieldRule{.unit = "EV", .min = -30, .max = 30});
}

template <class Visitor>
void visit_fields(Visitor& v, RecordOptions& o) {
  v("outputs", o.outputs,
    FieldRule{.choices = {"video", "png", "depth_png", "depth_exr", "segmentation", "metrics",
                          "contact_sheet"}});
}

/// [scene]
struct SceneHeader {
  std::string name;
};
template <class Visitor>
void visit_fields(Visitor& v, SceneHeader& o) {
  v("name", o.name, FieldRule{.identifier = true});
}

/// The tables of a scene file.
template <class Visitor>
void visit_tables(Visitor& v, SceneHeader& header, Scene& scene) {
  v("scene", header, FieldRule{});
  v("sim", scene.sim, FieldRule{});
  v("environment", scene.environment, FieldRule{});
  v("robot", scene.robots, FieldRule{});
  v("camera", scene.cameras, FieldRule{});
  v("material", scene.materials, FieldRule{});
  v("push", scene.pushes, FieldRule{});
  v("render", scene.render, FieldRule{});
  v("record", scene.record, FieldRule{});
}

}  // namespace gloam
