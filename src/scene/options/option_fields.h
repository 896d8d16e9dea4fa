#pragma once
// The list of every option of a scene file: one line per field (key, member, unit, range).
// The TOML reader and writer, the JSON schema, `gloam schema` and overrides on the command line are
// derived from it.
//
// A Visitor is called once per field as visitor(key, member, FieldRule). Positions in
// the file (`loc` members) are not listed; the reader fills them.

#include <string>

#include "gloam/scene.h"
#include "scene/options/agent_fields.h"
#include "scene/options/bridge_fields.h"
#include "scene/options/camera_fields.h"
#include "scene/options/effect_fields.h"
#include "scene/options/environment_fields.h"
#include "scene/options/field_rule.h"
#include "scene/options/imager_fields.h"
#include "scene/options/lidar_fields.h"
#include "scene/options/light_fields.h"
#include "scene/options/material_fields.h"
#include "scene/options/metric_fields.h"
#include "scene/options/object_fields.h"
#include "scene/options/planner_fields.h"
#include "scene/options/probe_fields.h"
#include "scene/options/robot_fields.h"
#include "scene/options/run_fields.h"
#include "scene/options/weather_fields.h"

namespace gloam {

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
  v("probe", scene.probes, FieldRule{});
  v("temperature", scene.temperatures, FieldRule{});
  v("randomize", scene.randomize, FieldRule{});
  v("render", scene.render, FieldRule{});
  v("record", scene.record, FieldRule{});
  v("topic", scene.topics, FieldRule{});
  v("metric", scene.metrics, FieldRule{});
  v("goal", scene.goals, FieldRule{});
  v("planner", scene.planner, FieldRule{});
  v("bridge", scene.bridge, FieldRule{});
}

}  // namespace gloam
