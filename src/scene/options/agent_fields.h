#pragma once
// The fields of [[agent]], [[crowd]] and [navigation]: a part of scene/options/option_fields.h.

#include <array>

#include "scene/options/field_rule.h"

namespace gloam {

inline constexpr std::array<std::string_view, 4> kAgentKinds = {"person", "cart", "forklift",
                                                                "car"};
inline constexpr std::array<std::string_view, 5> kAgentBehaviors = {"stand", "wander", "route",
                                                                    "spline", "tree"};
inline constexpr FieldRule kAgentSpeed{.unit = "m/s", .min = 0, .max = 60, .open = true};

template <class Visitor>
void visit_fields(Visitor& v, NavigationOptions& o) {
  v("cell", o.cell, FieldRule{.unit = "m", .min = 0.02, .max = 2});
  v("headroom", o.headroom, FieldRule{.unit = "m", .min = 0.1, .max = 10});
  v("radius", o.radius, FieldRule{.unit = "m", .min = 0.01, .max = 5});
  v("climb", o.climb, FieldRule{.unit = "m", .min = 0, .max = 2});
  v("slope", o.slope, FieldRule{.unit = "deg", .min = 0, .max = 89});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0.5, .max = 1000});
}

template <class Visitor>
void visit_fields(Visitor& v, WaypointOptions& o) {
  v("position", o.position,
    FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength, .required = true});
  v("pause", o.pause, FieldRule{.unit = "s", .min = 0, .max = kLongestTime});
}

template <class Visitor>
void visit_fields(Visitor& v, AgentOptions& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  v("kind", o.kind, FieldRule{.choices = words(kAgentKinds)});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("heading", o.heading, FieldRule{.unit = "deg", .min = -360, .max = 360});
  v("seed", o.seed, FieldRule{.max = 4294967295.0});
  v("height", o.height, FieldRule{.unit = "m", .min = 1.2, .max = 2.2});
  v("speed", o.speed, kAgentSpeed);
  v("behavior", o.behavior, FieldRule{.choices = words(kAgentBehaviors)});
  v("route", o.route, FieldRule{});
  v("loop", o.loop, FieldRule{});
  v("tree", o.tree, FieldRule{});
  v("start", o.start, FieldRule{.unit = "s", .min = 0, .max = kLongestTime});
  v("yields", o.yields, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, CrowdOptions& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  v("count", o.count, FieldRule{.min = 1, .max = 200});
  v("seed", o.seed, FieldRule{.max = 4294967295.0});
  v("speed", o.speed, kAgentSpeed);
  v("yields", o.yields, FieldRule{});
}

}  // namespace gloam
