#pragma once
// The list of every option a scene file may hold: one line per field (key, member, unit, range).
// The TOML reader, the overrides of the command line and later the schema and the manual all read
// it.
//
// A Visitor is called once per field as visitor(key, member, FieldRule). Where they stand in the
// file is the reader's business: `loc` members are not listed.

#include <string>

#include "gloam/scene.h"
#include "scene/options/agent_fields.h"
#include "scene/options/controller_types.h"
#include "scene/options/effect_fields.h"
#include "scene/options/environment_fields.h"
#include "scene/options/field_rule.h"
#include "scene/options/imager_fields.h"
#include "scene/options/lidar_fields.h"
#include "scene/options/light_fields.h"
#include "scene/options/pattern_names.h"
#include "scene/options/weather_fields.h"

namespace gloam {

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
  v("type", o.type, FieldRule{.choices = controller_type_names()});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
  v("kp", o.kp, FieldRule{.unit = "N m/rad", .min = 0, .max = 1e6});
  v("kd", o.kd, FieldRule{.unit = "N m s/rad", .min = 0, .max = 1e6});
  v("target", o.target, FieldRule{.unit = "rad or N m", .min = -1e6, .max = 1e6});
  v("goals", o.goals, FieldRule{});
  v("params", o.params, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RobotOptions& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  v("file", o.file, FieldRule{.required = true});
  v("position", o.X_WR.p, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", o.X_WR.q, FieldRule{.unit = "wxyz"});
  v("keyframe", o.keyframe, FieldRule{});
  v("base", o.base, FieldRule{.choices = {"model", "free"}});
  v("controller", o.controller, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RandomizeOptions& o) {
  v("option", o.option, FieldRule{.required = true});
  v("operation", o.operation, FieldRule{.choices = {"set", "add", "scale"}});
  v("uniform", o.uniform, FieldRule{});
  v("log_uniform", o.log_uniform, FieldRule{});
  v("normal", o.normal, FieldRule{});
  v("choice", o.choice, FieldRule{});
  v("weights", o.weights, FieldRule{.min = 0, .max = 1e9});
}

template <class Visitor>
void visit_fields(Visitor& v, EnvironmentOptions& o) {
  v("file", o.file, FieldRule{});
  v("up", o.up, kUpAxis);
  v("unit", o.unit, kFileUnit);
  v("colliders", o.colliders, FieldRule{.choices = words(kColliderKinds)});
  v("clash", o.clash, FieldRule{.choices = {"rename", "refuse", "prefix"}});
  v("house", o.house, FieldRule{});
  v("warehouse", o.warehouse, FieldRule{});
  v("office", o.office, FieldRule{});
  v("hallway", o.hallway, FieldRule{});
  v("bedroom", o.bedroom, FieldRule{});
  v("tunnel", o.tunnel, FieldRule{});
  v("terrain", o.terrain, FieldRule{});
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
  v("outputs", o.outputs, FieldRule{.choices = words(kCameraOutputs)});
  v("near", o.near, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("hide", o.hide, FieldRule{});
  visit_sensing(v, o.sensing);
}

template <class Visitor>
void visit_fields(Visitor& v, PatternOptions& o) {
  const FieldRule length{.unit = "m", .min = 1e-5, .max = kLargestLength};
  v("kind", o.kind, FieldRule{.required = true, .choices = words(kPatternKinds)});
  v("seed", o.seed, FieldRule{.max = 4294967295.0});
  v("color_a", o.color_a, kShare);
  v("color_b", o.color_b, kShare);
  v("color_c", o.color_c, kShare);
  v("scale", o.scale, length);
  v("size_u", o.size_u, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("size_v", o.size_v, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("gap", o.gap, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("depth", o.depth, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("roughness", o.roughness, kShare);
  v("coat", o.coat, kShare);
  v("variation", o.variation, kShare);
  v("amount", o.amount, kShare);
  v("axis", o.axis, FieldRule{.min = -1, .max = 1});
  v("basis", o.basis, FieldRule{.choices = words(kNoiseBases)});
  v("bond", o.bond, FieldRule{.choices = words(kBrickBonds)});
  v("tile", o.tile, FieldRule{.choices = words(kTileShapes)});
  v("weave", o.weave, FieldRule{.choices = words(kWeaves)});
}

template <class Visitor>
void visit_fields(Visitor& v, MaterialOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("base_color", o.base_color, kShare);
  v("metallic", o.metallic, kShare);
  v("roughness", o.roughness, kShare);
  v("emission", o.emission, FieldRule{.unit = "cd/m2", .min = 0, .max = 1e12});
  v("ior", o.ior, FieldRule{.min = 1, .max = 3});
  v("anisotropy", o.anisotropy, kShare);
  v("anisotropy_rotation", o.anisotropy_rotation, FieldRule{.unit = "turn", .min = -1, .max = 1});
  v("transmission_weight", o.transmission_weight, kShare);
  v("transmission_color", o.transmission_color, kShare);
  v("transmission_depth", o.transmission_depth,
    FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("thin_walled", o.thin_walled, FieldRule{});
  v("subsurface_weight", o.subsurface_weight, kShare);
  v("subsurface_color", o.subsurface_color, kShare);
  v("coat_weight", o.coat_weight, kShare);
  v("coat_roughness", o.coat_roughness, kShare);
  v("coat_ior", o.coat_ior, FieldRule{.min = 1, .max = 3});
  v("coat_color", o.coat_color, kShare);
  v("coat_darkening", o.coat_darkening, kShare);
  v("fuzz_weight", o.fuzz_weight, kShare);
  v("fuzz_roughness", o.fuzz_roughness, kShare);
  v("fuzz_color", o.fuzz_color, kShare);
  v("pattern", o.pattern, FieldRule{});
  v("wear", o.wear, FieldRule{});
  v("wetness", o.wetness, kShare);
  v("porosity", o.porosity, kShare);
  v("dust", o.dust, kShare);
  v("snow", o.snow, kShare);
  v("coat_weight_map", o.coat_weight_map, FieldRule{});
  v("coat_roughness_map", o.coat_roughness_map, FieldRule{});
  v("transmission_weight_map", o.transmission_weight_map, FieldRule{});
  v("bump", o.bump, FieldRule{});
  v("bump_scale", o.bump_scale, FieldRule{.unit = "m", .min = -10, .max = 10});
}

template <class Visitor>
void visit_fields(Visitor& v, VisualOptions& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  visit_placed_file(v, o, o.X_BV);
  v("node", o.node, FieldRule{});
  v("body", o.body, FieldRule{});
  v("casts_shadow", o.casts_shadow, FieldRule{});
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
  v("tier", o.tier, FieldRule{.choices = {"path", "fast", "direct"}});
  v("look", o.look, FieldRule{.choices = {"auto", "studio", "model"}});
  v("spp", o.spp, FieldRule{.min = 1, .max = 65536});
  v("error", o.error, FieldRule{.min = 1e-4, .max = 1});
  v("max_depth", o.max_depth, FieldRule{.min = 1, .max = 64});
  v("device", o.device, FieldRule{.choices = {"auto", "cpu", "cuda"}});
  v("denoise", o.denoise, FieldRule{});
  v("ev100", o.ev100, FieldRule{.unit = "EV", .min = -30, .max = 30});
  v("groups", o.groups, FieldRule{.min = 0, .max = 5});
  v("sites", o.sites, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RecordOptions& o) {
  v("outputs", o.outputs, FieldRule{.choices = words(kRecordOutputs)});
}

/// [scene]: the file itself.
struct SceneHeader {
  std::string name;  ///< in messages and results
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
  v("prop", scene.props, FieldRule{});
  v("object", scene.objects, FieldRule{});
  v("hfield", scene.hfields, FieldRule{});
  v("robot", scene.robots, FieldRule{});
  v("override", scene.overrides, FieldRule{});
  v("camera", scene.cameras, FieldRule{});
  v("lidar", scene.lidars, FieldRule{});
  v("material", scene.materials, FieldRule{});
  v("light", scene.lights, FieldRule{});
  v("sky", scene.sky, FieldRule{});
  v("blackout", scene.blackout, FieldRule{});
  v("volume", scene.volumes, FieldRule{});
  v("gas", scene.gases, FieldRule{});
  v("fire", scene.fires, FieldRule{});
  v("smoke", scene.smokes, FieldRule{});
  v("rotor", scene.rotors, FieldRule{});
  v("dust", scene.dusts, FieldRule{});
  v("weather", scene.weather, FieldRule{});
  v("adversity", scene.adversity, FieldRule{});
  v("water", scene.waters, FieldRule{});
  v("soil", scene.soils, FieldRule{});
  v("navigation", scene.navigation, FieldRule{});
  v("agent", scene.agents, FieldRule{});
  v("crowd", scene.crowds, FieldRule{});
  v("visual", scene.visuals, FieldRule{});
  v("push", scene.pushes, FieldRule{});
  v("stereo", scene.stereo, FieldRule{});
  v("rgbd", scene.rgbd, FieldRule{});
  v("sensor", scene.sensors, FieldRule{});
  v("temperature", scene.temperatures, FieldRule{});
  v("randomize", scene.randomize, FieldRule{});
  v("render", scene.render, FieldRule{});
  v("record", scene.record, FieldRule{});
}

}  // namespace gloam
