#pragma once
// Options of generated environments and props, as in option_fields.h.

#include "gloam/scene_environment.h"
#include "gloam/scene_object.h"
#include "places/catalogue.h"
#include "scene/options/field_rule.h"

namespace gloam {

inline constexpr std::array<std::string_view, 7> kColliderKinds = {
    "auto", "box", "sphere", "capsule", "hull", "hulls", "none"};

inline const FieldRule kUpAxis{.choices = {"auto", "y", "z"}};
inline const FieldRule kFileUnit{.unit = "m", .min = 1e-9, .max = 1e6};
inline const FieldRule kRoomHeight{.unit = "m", .min = 2.2, .max = 4};
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

/// What furnished places have in common.
template <class Visitor, class Options>
void visit_furnishing(Visitor& v, Options& o) {
  v("passage", o.passage, FieldRule{.unit = "m", .min = 0.4, .max = 1.2});
  v("clutter", o.clutter, kShare);
  v("loose", o.loose, kShare);
  v("roof", o.roof, FieldRule{});
}
template <class Visitor, class Options>
void visit_doors(Visitor& v, Options& o) {
  v("doors", o.doors, FieldRule{.choices = {"open", "ajar", "closed"}});
  v("openable", o.openable, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, HouseOptions& o) {
  v("seed", o.seed, FieldRule{});
  v("rooms", o.rooms, FieldRule{.min = 3, .max = 12});
  v("storeys", o.storeys, FieldRule{.min = 1, .max = 2});
  v("ceiling", o.ceiling, kRoomHeight);
  visit_furnishing(v, o);
  visit_doors(v, o);
  v("furnished", o.furnished, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, WarehouseOptions& o) {
  v("seed", o.seed, FieldRule{});
  v("length", o.length, FieldRule{.unit = "m", .min = 12, .max = 120});
  v("width", o.width, FieldRule{.unit = "m", .min = 10, .max = 80});
  v("height", o.height, FieldRule{.unit = "m", .min = 4, .max = 14});
  v("aisle", o.aisle, FieldRule{.unit = "m", .min = 1.2, .max = 6});
  v("levels", o.levels, FieldRule{.min = 1, .max = 6});
  v("fill", o.fill, kShare);
  v("clutter", o.clutter, kShare);
  v("loose", o.loose, kShare);
  v("dock_doors", o.dock_doors, FieldRule{.min = 0, .max = 12});
}

template <class Visitor>
void visit_fields(Visitor& v, OfficeOptions& o) {
  v("seed", o.seed, FieldRule{});
  v("length", o.length, FieldRule{.unit = "m", .min = 10, .max = 60});
  v("width", o.width, FieldRule{.unit = "m", .min = 9, .max = 24});
  v("ceiling", o.ceiling, FieldRule{.unit = "m", .min = 2.4, .max = 4});
  visit_furnishing(v, o);
  visit_doors(v, o);
  v("furnished", o.furnished, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, HallwayOptions& o) {
  v("seed", o.seed, FieldRule{});
  v("length", o.length, FieldRule{.unit = "m", .min = 8, .max = 200});
  v("width", o.width, FieldRule{.unit = "m", .min = 1.6, .max = 6});
  v("ceiling", o.ceiling, FieldRule{.unit = "m", .min = 2.3, .max = 5});
  v("turns", o.turns, FieldRule{.min = 0, .max = 3});
  visit_furnishing(v, o);
}

template <class Visitor>
void visit_fields(Visitor& v, BedroomOptions& o) {
  v("seed", o.seed, FieldRule{});
  v("width", o.width, FieldRule{.unit = "m", .min = 3, .max = 8});
  v("depth", o.depth, FieldRule{.unit = "m", .min = 3, .max = 8});
  v("ceiling", o.ceiling, kRoomHeight);
  visit_furnishing(v, o);
  visit_doors(v, o);
}

template <class Visitor>
void visit_fields(Visitor& v, TunnelOptions& o) {
  v("seed", o.seed, FieldRule{});
  v("length", o.length, FieldRule{.unit = "m", .min = 20, .max = 400});
  v("width", o.width, FieldRule{.unit = "m", .min = 3, .max = 12});
  v("height", o.height, FieldRule{.unit = "m", .min = 2.6, .max = 9});
  v("curve", o.curve, FieldRule{.unit = "m", .min = 60, .max = 5000});
  v("lamps", o.lamps, FieldRule{.unit = "m", .min = 4, .max = 60});
  v("failed", o.failed, kShare);
  v("clutter", o.clutter, kShare);
  v("loose", o.loose, kShare);
}

template <class Visitor>
void visit_fields(Visitor& v, TerrainOptions& o) {
  v("seed", o.seed, FieldRule{});
  v("length", o.length, FieldRule{.unit = "m", .min = 20, .max = 200});
  v("width", o.width, FieldRule{.unit = "m", .min = 20, .max = 200});
  v("relief", o.relief, FieldRule{.unit = "m", .min = 0, .max = 20});
  v("resolution", o.resolution, FieldRule{.unit = "m", .min = 0.05, .max = 1});
  v("road", o.road, FieldRule{.unit = "m", .min = 0, .max = 8});
  v("water", o.water, FieldRule{});
  v("grass", o.grass, kShare);
  v("rocks", o.rocks, kShare);
  v("trees", o.trees, kShare);
  v("buildings", o.buildings, FieldRule{.min = 0, .max = 3});
  v("loose", o.loose, kShare);
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
