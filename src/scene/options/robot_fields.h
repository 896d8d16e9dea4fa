#pragma once
// Fields of [[robot]], its controller and [[push]]. A part of
// scene/options/option_fields.h.

#include "gloam/scene/robot.h"
#include "scene/options/actuator_fields.h"
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
  v("vz", o.vz, FieldRule{.unit = "m/s", .min = -kLargestSpeed, .max = kLargestSpeed});
}

template <class Visitor>
void visit_fields(Visitor& v, Waypoint& o) {
  v("position", o.position,
    FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength, .required = true});
  v("yaw", o.yaw, FieldRule{.unit = "rad", .min = -1e3, .max = 1e3});
  v("speed", o.speed, FieldRule{.unit = "m/s", .min = 0, .max = kLargestSpeed, .open = true});
  v("hold", o.hold, FieldRule{.unit = "s", .min = 0, .max = kLongestTime});
}

template <class Visitor>
void visit_fields(Visitor& v, FlightOptions& o) {
  const FieldRule speed{.unit = "m/s", .min = 0, .max = kLargestSpeed, .open = true};
  v("waypoints", o.waypoints, FieldRule{});
  v("max_speed", o.max_speed, speed);
  v("max_climb", o.max_climb, speed);
  v("max_acceleration", o.max_acceleration,
    FieldRule{.unit = "m/s2", .min = 0, .max = 1e3, .open = true});
  v("max_tilt", o.max_tilt, FieldRule{.unit = "rad", .min = 0, .max = 1.5, .open = true});
  v("max_yaw_rate", o.max_yaw_rate, FieldRule{.unit = "rad/s", .min = 0, .max = 100, .open = true});
  v("tolerance", o.tolerance, FieldRule{.unit = "m", .min = 0, .max = 1e3, .open = true});
  v("position_gain", o.position_gain, FieldRule{.unit = "1/s", .min = 0, .max = 1e3});
  v("velocity_gains", o.velocity_gains, FieldRule{.unit = "1/s, 1/s2, 1", .min = 0, .max = 1e4});
  v("attitude_gain", o.attitude_gain, FieldRule{.unit = "1/s", .min = 0, .max = 1e3});
  v("rate_gains", o.rate_gains, FieldRule{.unit = "1/s, 1/s2, 1", .min = 0, .max = 1e4});
}

template <class Visitor>
void visit_fields(Visitor& v, DriveOptions& o) {
  v("left", o.left, FieldRule{});
  v("right", o.right, FieldRule{});
  v("wheel_radius", o.wheel_radius, FieldRule{.unit = "m", .min = 0, .max = 100});
  v("track", o.track, FieldRule{.unit = "m", .min = 0, .max = 100});
  v("max_speed", o.max_speed, FieldRule{.unit = "m/s", .min = 0, .max = kLargestSpeed});
  v("max_yaw_rate", o.max_yaw_rate, FieldRule{.unit = "rad/s", .min = 0, .max = kLargestSpeed});
  v("max_acceleration", o.max_acceleration,
    FieldRule{.unit = "m/s2", .min = 0, .max = 1e4, .open = true});
  v("max_yaw_acceleration", o.max_yaw_acceleration,
    FieldRule{.unit = "rad/s2", .min = 0, .max = 1e4, .open = true});
}

template <class Visitor>
void visit_fields(Visitor& v, GripOptions& o) {
  v("force", o.force, FieldRule{.unit = "N or N m", .min = 0, .max = 1e6, .open = true});
  v("speed", o.speed, FieldRule{.unit = "m/s or rad/s", .min = 0, .max = 1e3, .open = true});
  v("opening", o.opening, kShare);
  v("inverted", o.inverted, FieldRule{});
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
  of_type("flight", o.flight, FieldRule{});
  of_type("drive", o.drive, FieldRule{});
  of_type("grip", o.grip, FieldRule{});
  of_type("network", o.network, FieldRule{});
  of_type("settings", o.settings, FieldRule{});
  of_type("params", o.params, FieldRule{});
  TaskSpaceOptions& t = o.task;
  of_type("frame", t.frame, FieldRule{});
  of_type("position_cost", t.position_cost, FieldRule{.unit = "1/m", .min = 0, .max = 1e6});
  of_type("orientation_cost", t.orientation_cost, FieldRule{.unit = "1/rad", .min = 0, .max = 1e6});
  of_type("posture_cost", t.posture_cost,
          FieldRule{.unit = "1/rad or 1/m", .min = 0, .max = 1e6, .open = true});
  of_type("time_constant", t.time_constant, FieldRule{.unit = "s", .min = 0, .max = 1e3});
  of_type("velocity_limit", t.velocity_limit,
          FieldRule{.unit = "rad/s or m/s", .min = 0, .max = kLargestSpeed, .open = true});
  of_type("collision_distance", t.collision_distance,
          FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  of_type("position_stiffness", t.position_stiffness,
          FieldRule{.unit = "1/s^2", .min = 0, .max = 1e6});
  of_type("orientation_stiffness", t.orientation_stiffness,
          FieldRule{.unit = "1/s^2", .min = 0, .max = 1e6});
  of_type("posture_stiffness", t.posture_stiffness,
          FieldRule{.unit = "1/s^2", .min = 0, .max = 1e6});
  of_type("damping_ratio", t.damping_ratio, FieldRule{.min = 0, .max = 100});
}

template <class Visitor>
void visit_fields(Visitor& v, RobotPart& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  v("joints", o.joints, FieldRule{.required = true});
  v("controller", o.controller, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RobotJoints& o) {
  v("FL", o.front_left, FieldRule{});
  v("FR", o.front_right, FieldRule{});
  v("RL", o.rear_left, FieldRule{});
  v("RR", o.rear_right, FieldRule{});
  v("feet", o.feet, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RobotOptions& o) {
  v("model", o.model, FieldRule{});  // first: name and file depend on it
  const bool is_own = o.model.empty();
  v("name", o.name,
    FieldRule{.required = is_own, .identifier = true, .may_be_empty = !is_own, .unless = "model"});
  v("file", o.file, FieldRule{.required = is_own, .unless = "model"});
  v("sensors", o.sensors, FieldRule{});
  v("position", o.X_WR.p, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", o.X_WR.q, FieldRule{.unit = "wxyz"});
  v("keyframe", o.keyframe, FieldRule{});
  v("base", o.base, FieldRule{.choices = {"model", "free"}});
  v("controller", o.controller, FieldRule{});
  v("part", o.parts, FieldRule{});
  v("joints", o.joints, FieldRule{});
  v("actuators", o.actuators, FieldRule{});
  v("actuator", o.actuator, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, PushOptions& o) {
  v("body", o.body, FieldRule{.required = true});
  v("time", o.time, FieldRule{.unit = "s", .min = 0, .max = kLongestTime, .required = true});
  v("velocity", o.velocity, FieldRule{.unit = "m/s", .min = -kLargestSpeed, .max = kLargestSpeed});
}

}  // namespace gloam
