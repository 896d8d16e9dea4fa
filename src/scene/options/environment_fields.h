#pragma once
// Fields of [environment] and of generated places. A part of
// scene/options/option_fields.h.

#include "gloam/scene/environment.h"
#include "scene/options/field_rule.h"
#include "scene/options/object_fields.h"

namespace gloam {

inline const FieldRule kRoomHeight{.unit = "m", .min = 2.2, .max = 4};

/// Fields that furnished places have in common.
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
void visit_fields(Visitor& v, MineOptions& o) {
  v("seed", o.seed, FieldRule{});
  v("length", o.length, FieldRule{.unit = "m", .min = 20, .max = 400});
  v("width", o.width, FieldRule{.unit = "m", .min = 3, .max = 10});
  v("height", o.height, FieldRule{.unit = "m", .min = 2.6, .max = 8});
  v("curve", o.curve, FieldRule{.unit = "m", .min = 40, .max = 5000});
  v("relief", o.relief, FieldRule{.unit = "m", .min = 0.05, .max = 0.5});
  v("supports", o.supports, FieldRule{.unit = "m", .min = 0, .max = 50});
  v("niches", o.niches, FieldRule{.unit = "m", .min = 0, .max = 200});
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
  v("mine", o.mine, FieldRule{});
  v("terrain", o.terrain, FieldRule{});
}

}  // namespace gloam
