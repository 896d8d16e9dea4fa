#pragma once
// The fields of [[probe]]: a part of scene/options/option_fields.h.

#include "scene/options/field_rule.h"
#include "scene/options/probe_quantities.h"

namespace gloam {

template <class Visitor>
void visit_fields(Visitor& v, ProbeOptions& o) {
  v("name", o.name, FieldRule{.required = true});  // ROBOT/SENSOR from a catalogue's robot
  v("quantity", o.quantity, FieldRule{.required = true, .choices = words(kProbeWords)});
  v("position", o.position, FieldRule{.unit = "m", .min = -kLargestLength, .max = kLargestLength});
  v("body", o.body, FieldRule{});
  v("agent", o.agent, FieldRule{});
  v("camera", o.camera, FieldRule{});
  v("normal", o.normal, FieldRule{.min = -kLargestLength, .max = kLargestLength});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
}

}  // namespace gloam
