#pragma once
// Fields of [[robot]], its controller and [[push]]. A part of
// scene/options/option_fields.h.

#include "gloam/scene/robot.h"
#include "scene/options/controller_types.h"
#include "scene/options/field_rule.h"

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
  const auto of_type = [&](std::string_view key, auto& member, FieldRule rule) {
    if (!has_controller_option(o.type, key)) rule.not_of = o.type;
    v(key, member, rule);
  };
  of_type("kp", o.kp, FieldRule{.unit = "N m/rad", .min = 0, .max = 1e6});
  of_type("kd", o.kd, FieldRule{.unit = "N m s/rad", .min = 0, .max = 1e6});
  of_type("target", o.target, FieldRule{.unit = "rad or N m", .min = -1e6, .max = 1e6});
  of_type("goals", o.goals, FieldRule{});
  of_type("params", o.params, FieldRule{});
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
void visit_fields(Visitor& v, PushOptions& o) {
  v("body", o.body, FieldRule{.required = true});
  v("time", o.time, FieldRule{.unit = "s", .min = 0, .max = kLongestTime, .required = true});
  v("velocity", o.velocity, FieldRule{.unit = "m/s", .min = -kLargestSpeed, .max = kLargestSpeed});
}

}  // namespace gloam
