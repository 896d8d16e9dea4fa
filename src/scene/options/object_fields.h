#pragma once
// Fields of [[prop]], [[object]], [[visual]] and [[hfield]]. A part of
// scene/options/option_fields.h.

#include <array>
#include <string_view>
#include <type_traits>

#include "gloam/scene/object.h"
#include "places/catalogue.h"
#include "scene/options/field_rule.h"

namespace gloam {

inline constexpr std::array<std::string_view, 7> kColliderKinds = {
    "auto", "box", "sphere", "capsule", "hull", "hulls", "none"};

inline const FieldRule kUpAxis{.choices = {"auto", "y", "z"}};
inline const FieldRule kFileUnit{.unit = "m", .min = 1e-9, .max = 1e6};
inline const FieldRule kFriction{.min = 0, .max = 100};

/// A mesh file, and where and how large it is; X = `position` and `orientation` of `o`.
template <class Visitor, class Options>
void visit_placed_file(Visitor& v, Options& o, Pose& X) {
  v("file", o.file, FieldRule{.required = true});
  v("position", X.p, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", X.q, FieldRule{.unit = "wxyz"});
  // Below zero: mirrored. Ground is not. validate_scene refuses what is too small.
  constexpr bool is_ground = std::is_same_v<Options, HeightFieldOptions>;
  v("scale", o.scale, FieldRule{.min = is_ground ? 1e-6 : -1e6, .max = 1e6, .one_for_three = true});
  v("up", o.up, kUpAxis);
  v("unit", o.unit, kFileUnit);
}

template <class Visitor>
void visit_fields(Visitor& v, PropOptions& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  v("kind", o.kind, FieldRule{.required = true, .choices = prop_kind_names()});
  v("seed", o.seed, FieldRule{});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("orientation", o.orientation, FieldRule{.unit = "wxyz"});
  v("size", o.size, FieldRule{.unit = "m", .min = 0.01, .max = 100});
  v("color", o.color, kShare);
  v("loose", o.loose, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, ObjectOptions& o) {
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  visit_placed_file(v, o, o.X_WO);
  v("node", o.node, FieldRule{});
  v("motion", o.motion, FieldRule{.choices = {"static", "dynamic", "mocap"}});
  v("density", o.density, FieldRule{.unit = "kg/m3", .min = 0.01, .max = 1e5});
  v("mass", o.mass, FieldRule{.unit = "kg", .min = 1e-6, .max = 1e9});
  v("colliders", o.colliders, FieldRule{.choices = words(kColliderKinds)});
  v("concavity", o.concavity, FieldRule{.min = 0.01, .max = 1});
  v("max_hulls", o.max_hulls, FieldRule{.min = 1, .max = 256});
  v("friction", o.friction, kFriction);
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
void visit_fields(Visitor& v, HeightFieldOptions& o) {
  const FieldRule corner{.unit = "m", .min = -kLargestLength, .max = kLargestLength};
  v("name", o.name, FieldRule{.required = true, .identifier = true});
  visit_placed_file(v, o, o.X_WF);
  v("low", o.low, corner);
  v("high", o.high, corner);
  v("resolution", o.resolution, FieldRule{.unit = "m", .min = 1e-4, .max = 1e4});
  v("layers", o.layers, FieldRule{.min = 1, .max = 8});
  v("friction", o.friction, kFriction);
  v("drawn", o.drawn, FieldRule{});
}

}  // namespace gloam
