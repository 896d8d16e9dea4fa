#pragma once
// Fields of [[material]] and its patterns. A part of
// scene/options/option_fields.h.

#include "gloam/scene/material.h"
#include "scene/options/field_rule.h"
#include "scene/options/pattern_names.h"

namespace gloam {

template <class Visitor>
void visit_fields(Visitor& v, PatternOptions& o) {
  const FieldRule length{.unit = "m", .min = 1e-5, .max = kLargestLength};
  v("kind", o.kind, FieldRule{.required = true, .choices = words(kPatternKinds)});
  v("seed", o.seed, FieldRule{.max = 4294967295.0});
  v("color_a", o.color_a, kShare);
  v("color_b", o.color_b, kShare);
  v("color_c", o.color_c, kShare);
  v("scale", o.scale, length);
  v("size_u", o.size_u, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("size_v", o.size_v, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("gap", o.gap, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("depth", o.depth, FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("roughness", o.roughness, kShare);
  v("coat", o.coat, kShare);
  v("variation", o.variation, kShare);
  v("amount", o.amount, kShare);
  v("axis", o.axis, FieldRule{.min = -1, .max = 1});
  v("basis", o.basis, FieldRule{.choices = words(kNoiseBases)});
  v("bond", o.bond, FieldRule{.choices = words(kBrickBonds)});
  v("tile", o.tile, FieldRule{.choices = words(kTileShapes)});
  v("weave", o.weave, FieldRule{.choices = words(kWeaves)});
}

template <class Visitor>
void visit_fields(Visitor& v, MaterialOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("base_color", o.base_color, kShare);
  v("metallic", o.metallic, kShare);
  v("roughness", o.roughness, kShare);
  v("emission", o.emission, FieldRule{.unit = "cd/m2", .min = 0, .max = 1e12});
  v("ior", o.ior, FieldRule{.min = 1, .max = 3});
  v("anisotropy", o.anisotropy, kShare);
  v("anisotropy_rotation", o.anisotropy_rotation, FieldRule{.unit = "turn", .min = -1, .max = 1});
  v("transmission_weight", o.transmission_weight, kShare);
  v("transmission_color", o.transmission_color, kShare);
  v("transmission_depth", o.transmission_depth,
    FieldRule{.unit = "m", .min = 0, .max = kLargestLength});
  v("thin_walled", o.thin_walled, FieldRule{});
  v("subsurface_weight", o.subsurface_weight, kShare);
  v("subsurface_color", o.subsurface_color, kShare);
  v("coat_weight", o.coat_weight, kShare);
  v("coat_roughness", o.coat_roughness, kShare);
  v("coat_ior", o.coat_ior, FieldRule{.min = 1, .max = 3});
  v("coat_color", o.coat_color, kShare);
  v("coat_darkening", o.coat_darkening, kShare);
  v("fuzz_weight", o.fuzz_weight, kShare);
  v("fuzz_roughness", o.fuzz_roughness, kShare);
  v("fuzz_color", o.fuzz_color, kShare);
  v("pattern", o.pattern, FieldRule{});
  v("wear", o.wear, FieldRule{});
  v("wetness", o.wetness, kShare);
  v("porosity", o.porosity, kShare);
  v("dust", o.dust, kShare);
  v("snow", o.snow, kShare);
  v("coat_weight_map", o.coat_weight_map, FieldRule{});
  v("coat_roughness_map", o.coat_roughness_map, FieldRule{});
  v("transmission_weight_map", o.transmission_weight_map, FieldRule{});
  v("bump", o.bump, FieldRule{});
  v("bump_scale", o.bump_scale, FieldRule{.unit = "m", .min = -10, .max = 10});
}

}  // namespace gloam
