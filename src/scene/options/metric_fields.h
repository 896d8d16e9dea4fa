#pragma once
// Fields of [[metric]] and [[goal]]. A part of scene/options/option_fields.h.

#include "gloam/scene/metric.h"
#include "scene/options/field_rule.h"

namespace gloam {

template <class Visitor>
void visit_fields(Visitor& v, MetricOptions& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  v("value", o.value, FieldRule{.required = true});
  v("unit", o.unit, FieldRule{});
  v("robots", o.robots, FieldRule{});
  v("reduce", o.reduce,
    FieldRule{.choices = {"last", "mean", "min", "max", "rms", "sum", "integral", "first_time_true",
                          "fraction_true"}});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
}

template <class Visitor>
void visit_fields(Visitor& v, GoalOptions& o) {
  v("robot", o.robot, FieldRule{.required = true});
  v("position", o.position,
    FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength, .required = true});
  v("radius", o.radius, FieldRule{.unit = "m", .min = 0, .max = kLargestLength, .open = true});
  v("time_limit", o.time_limit, FieldRule{.unit = "s", .min = 0, .max = kLongestTime});
  v("shortest_path", o.shortest_path, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("top_speed", o.top_speed, FieldRule{.unit = "m/s", .min = 0, .max = kLargestSpeed});
}

}  // namespace gloam
