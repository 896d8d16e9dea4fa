#pragma once
// The fields of [planner]: a part of scene/options/option_fields.h.

#include "scene/options/field_rule.h"

namespace gloam {

template <class Visitor>
void visit_fields(Visitor& v, PlannerOptions& o) {
  v("type", o.type, FieldRule{.required = true});
  v("robot", o.robot, FieldRule{});
  v("camera", o.camera, FieldRule{});
  v("lidar", o.lidar, FieldRule{});
  v("map", o.map, FieldRule{});
  v("weights", o.weights, FieldRule{});
  v("library", o.library, FieldRule{});
  v("command", o.command, FieldRule{});
  v("address", o.address, FieldRule{});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = 1000});
  v("latency", o.latency, FieldRule{.unit = "s", .min = -1, .max = 60});
  v("top_speed", o.top_speed, FieldRule{.unit = "m/s", .min = 0, .max = 100, .open = true});
}

}  // namespace gloam
