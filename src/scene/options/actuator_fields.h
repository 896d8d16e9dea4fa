#pragma once
// Fields of [robot.actuators] and [[robot.actuator]]. A part of scene/options/option_fields.h.

#include "gloam/scene/actuator.h"
#include "scene/options/field_rule.h"

namespace gloam {

inline constexpr double kLargestTorque = 1e6;  // [N m]

inline FieldRule torque_rule() { return {.unit = "N m", .min = 0, .max = kLargestTorque}; }

template <class Visitor>
void visit_fields(Visitor& v, ActuatorFriction& o) {
  const FieldRule speed{.unit = "rad/s", .min = 0, .max = kLargestSpeed, .open = true};
  v("coulomb", o.coulomb, torque_rule());
  v("breakaway", o.breakaway, torque_rule());
  v("stribeck_speed", o.stribeck_speed, speed);
  v("viscous", o.viscous, FieldRule{.unit = "N m s/rad", .min = 0, .max = kLargestTorque});
  v("smoothing", o.smoothing, speed);
}

template <class Visitor>
void visit_fields(Visitor& v, MotorThermal& o) {
  const FieldRule celsius{.unit = "°C", .min = -100, .max = 500};
  v("thermal_resistance", o.thermal_resistance,
    FieldRule{.unit = "K/W", .min = 0, .max = 1e6, .open = true, .required = true});
  v("heat_capacity", o.heat_capacity,
    FieldRule{.unit = "J/K", .min = 0, .max = 1e9, .open = true, .required = true});
  v("derate_start", o.derate_start, celsius);
  v("cutoff", o.cutoff, celsius);
  v("ambient", o.ambient, celsius);
}

template <class Visitor>
void visit_fields(Visitor& v, ActuatorNetworkOptions& o) {
  const FieldRule scale{.min = -1e6, .max = 1e6};
  v("file", o.file, FieldRule{.required = true});
  v("period", o.period, FieldRule{.unit = "s", .min = 0, .max = 1, .open = true});
  v("history", o.history, FieldRule{.min = 1, .max = 100});
  v("order", o.order, FieldRule{.choices = {"position_velocity", "velocity_position"}});
  v("position_scale", o.position_scale, scale);
  v("velocity_scale", o.velocity_scale, scale);
  v("torque_scale", o.torque_scale, scale);
  v("kp", o.kp, FieldRule{.unit = "N m/rad", .min = 0, .max = kLargestTorque, .open = true});
  v("kd", o.kd, FieldRule{.unit = "N m s/rad", .min = 0, .max = kLargestTorque});
}

template <class Visitor>
void visit_fields(Visitor& v, PropellerOptions& o) {
  const FieldRule coefficient{.min = 0, .max = 10, .open = true};
  v("diameter", o.diameter,
    FieldRule{.unit = "m", .min = 0, .max = 100, .open = true, .required = true});
  FieldRule thrust = coefficient;
  thrust.required = true;
  v("thrust_coefficient", o.thrust_coefficient, thrust);
  v("power_coefficient", o.power_coefficient, coefficient);
  v("zero_thrust_advance", o.zero_thrust_advance, coefficient);
  v("zero_torque_advance", o.zero_torque_advance, coefficient);
  v("inertia", o.inertia, FieldRule{.unit = "kg m2", .min = 0, .max = 1e6});
  v("response_time", o.response_time, FieldRule{.unit = "s", .min = 0, .max = 100, .open = true});
  v("no_load_current", o.no_load_current, FieldRule{.unit = "A", .min = 0, .max = 1e6});
  v("current_limit", o.current_limit, FieldRule{.unit = "A", .min = 0, .max = 1e6});
  v("voltage", o.voltage, FieldRule{.unit = "V", .min = 0, .max = 1e4});
  v("air_density", o.air_density, FieldRule{.unit = "kg/m3", .min = 0, .max = 2e3, .open = true});
}

template <class Visitor>
void visit_fields(Visitor& v, ActuatorOptions& o) {
  v("actuators", o.actuators, FieldRule{});  // first: joints depends on it
  v("joints", o.joints, FieldRule{.required = o.actuators.empty(), .unless = "actuators"});
  v("gear_ratio", o.gear_ratio, FieldRule{.min = 0, .max = 1e6, .open = true});
  v("stall_torque", o.stall_torque, torque_rule());
  v("no_load_speed", o.no_load_speed, FieldRule{.unit = "rad/s", .min = 0, .max = 1e6});
  v("curve", o.curve, FieldRule{.unit = "rad/s, N m", .min = 0, .max = kLargestTorque});
  v("torque_limit", o.torque_limit, torque_rule());
  v("torque_constant", o.torque_constant, FieldRule{.unit = "N m/A", .min = 0, .max = 1e4});
  v("winding_resistance", o.winding_resistance, FieldRule{.unit = "ohm", .min = 0, .max = 1e6});
  v("delay", o.delay, FieldRule{.unit = "s", .min = 0, .max = 1});
  v("backlash", o.backlash, FieldRule{.unit = "rad", .min = 0, .max = 1});
  v("friction", o.friction, FieldRule{});
  v("thermal", o.thermal, FieldRule{});
  v("network", o.network, FieldRule{});
  v("propeller", o.propeller, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, BatteryOptions& o) {
  v("voltage", o.voltage, FieldRule{.unit = "V", .min = 0, .max = 1e4});
  v("curve", o.curve, FieldRule{.unit = "1, V", .min = 0, .max = 1e4});
  v("nominal_voltage", o.nominal_voltage,
    FieldRule{.unit = "V", .min = 0, .max = 1e4, .open = true});
  v("internal_resistance", o.internal_resistance, FieldRule{.unit = "ohm", .min = 0, .max = 1e3});
  v("capacity", o.capacity, FieldRule{.unit = "A h", .min = 0, .max = 1e6, .open = true});
  v("charge", o.charge, kShare);
  v("regenerates", o.regenerates, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, SharedActuatorOptions& o) {
  v("battery", o.battery, FieldRule{});
  v("idle_power", o.idle_power, FieldRule{.unit = "W", .min = 0, .max = 1e6});
}

}  // namespace gloam
