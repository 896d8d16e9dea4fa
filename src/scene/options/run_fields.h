#pragma once
// Fields of [sim], [render], [record] and [[randomize]]. A part of
// scene/options/option_fields.h.

#include "gloam/output_names.h"
#include "gloam/scene/run.h"
#include "scene/options/field_rule.h"

namespace gloam {

template <class Visitor>
void visit_fields(Visitor& v, SimOptions& o) {
  v("timestep", o.timestep, FieldRule{.unit = "s", .min = 0, .max = 1, .open = true});
  v("duration", o.duration, FieldRule{.unit = "s", .min = 0, .max = kLongestTime, .open = true});
  v("seed", o.seed, FieldRule{});
  v("pace", o.pace, FieldRule{.choices = {"fast", "realtime", "sensors"}, .may_be_empty = true});
}

template <class Visitor>
void visit_fields(Visitor& v, RenderOptions& o) {
  v("tier", o.tier, FieldRule{.choices = words<RenderTier>(), .may_be_empty = true});
  v("look", o.look, FieldRule{.choices = words<RenderLook>()});
  v("spp", o.spp, FieldRule{.min = 1, .max = 65536});
  v("error", o.error, FieldRule{.min = 1e-4, .max = 1});
  v("max_depth", o.max_depth, FieldRule{.min = 1, .max = 64});
  v("device", o.device, FieldRule{.choices = words<RenderDevice>()});
  v("denoise", o.denoise, FieldRule{});
  v("ev100", o.ev100, FieldRule{.unit = "EV", .min = -30, .max = 30});
  v("groups", o.groups, FieldRule{.min = 0, .max = 5});
  v("sites", o.sites, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RecordOptions& o) {
  v("outputs", o.outputs, FieldRule{.choices = words(kOutputNames)});
  v("mcap", o.mcap, FieldRule{});
  v("topics", o.topics, FieldRule{});
  v("state_rate", o.state_rate,
    FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
  v("metrics_rate", o.metrics_rate,
    FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
  v("embed", o.embed, FieldRule{});
  v("durable", o.durable, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, TopicOptions& o) {
  v("name", o.name, FieldRule{.required = true});
  v("rename", o.rename, FieldRule{});
  v("frame", o.frame, FieldRule{});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
  v("log", o.log, FieldRule{});
  v("off", o.off, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, RandomizeOptions& o) {
  v("option", o.option, FieldRule{.required = true});
  v("operation", o.operation, FieldRule{.choices = {"set", "add", "scale"}});
  v("uniform", o.uniform, FieldRule{});
  v("log_uniform", o.log_uniform, FieldRule{});
  v("normal", o.normal, FieldRule{});
  v("choice", o.choice, FieldRule{});
  v("weights", o.weights, FieldRule{.min = 0, .max = 1e9});
  v("seed", o.seed, FieldRule{});
}

}  // namespace gloam
