#pragma once
// Fields of [camera.imager], [camera.timing] and of other sensors' models. A part of
// scene/options/option_fields.h.

#include "gloam/scene/sensor.h"
#include "scene/options/field_rule.h"
#include "scene/options/pattern_names.h"

namespace gloam {

template <class Visitor>
void visit_fields(Visitor& v, TimingOptions& o) {
  const FieldRule duration{.unit = "s", .min = 0, .max = 1000};
  v("phase", o.phase, duration);
  v("jitter", o.jitter, duration);
  v("latency", o.latency, duration);
  v("latency_jitter", o.latency_jitter, duration);
  v("drop", o.drop, kShare);
}

template <class Visitor>
void visit_fields(Visitor& v, ExposureOptions& o) {
  v("f_number", o.f_number, FieldRule{.min = 0.5, .max = 64});
  v("shutter", o.shutter, FieldRule{.unit = "s", .min = 1e-7, .max = 60});
  v("iso", o.iso, FieldRule{.min = 1, .max = 1e6});
}

template <class Visitor>
void visit_fields(Visitor& v, AutoExposureOptions& o) {
  const FieldRule value{.unit = "EV", .min = -30, .max = 30};
  v("time_constant", o.time_constant, FieldRule{.unit = "s", .min = 1e-6, .max = 1000});
  v("compensation", o.compensation, value);
  v("metering", o.metering, FieldRule{.choices = {"average", "center"}});
  v("min_ev100", o.min_ev100, value);
  v("max_ev100", o.max_ev100, value);
  v("max_shutter", o.max_shutter, FieldRule{.unit = "s", .min = 1e-7, .max = 60});
  v("max_iso", o.max_iso, FieldRule{.min = 100, .max = 1e6});
}

template <class Visitor>
void visit_fields(Visitor& v, VignettingOptions& o) {
  v("cos4", o.cos4, FieldRule{});
  v("polynomial", o.polynomial, FieldRule{.min = -10, .max = 10});
}

template <class Visitor>
void visit_fields(Visitor& v, PixelOptions& o) {
  const FieldRule electrons{.unit = "e-", .min = 0, .max = 1e6};
  v("full_well", o.full_well, FieldRule{.unit = "e-", .min = 10, .max = 1e7});
  v("quantum_efficiency", o.quantum_efficiency, FieldRule{.min = 0.001, .max = 1});
  v("pitch", o.pitch, FieldRule{.unit = "µm", .min = 0.1, .max = 1000});
  v("shot_noise", o.shot_noise, FieldRule{});
  v("read_noise", o.read_noise, electrons);
  v("dark_current", o.dark_current, FieldRule{.unit = "e-/s", .min = 0, .max = 1e6});
  v("prnu", o.prnu, FieldRule{.min = 0, .max = 0.2});
  v("dsnu", o.dsnu, electrons);
  v("bits", o.bits, FieldRule{.min = 0, .max = 16});
  v("black_level", o.black_level, FieldRule{.unit = "DN", .min = 0, .max = 32767});
}

template <class Visitor>
void visit_fields(Visitor& v, ImagerOptions& o) {
  v("exposure", o.exposure, FieldRule{});
  v("auto_exposure", o.auto_exposure, FieldRule{});
  v("vignetting", o.vignetting, FieldRule{});
  v("pixel", o.pixel, FieldRule{});
  v("mosaic", o.mosaic, FieldRule{.choices = {"none", "rggb", "bggr", "grbg", "gbrg", "mono"}});
  v("white_balance", o.white_balance, FieldRule{.min = 1, .max = 10});
  v("curve", o.curve, FieldRule{.choices = {"neutral", "srgb"}});
  v("jpeg", o.jpeg, FieldRule{.min = 0, .max = 100});
  v("seed", o.seed, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, StereoDepthOptions& o) {
  const FieldRule range{.unit = "m", .min = 0, .max = 1000}, px{.unit = "px", .min = 0, .max = 100};
  v("preset", o.preset, FieldRule{.choices = words(kStereoPresets)});
  v("baseline", o.baseline, FieldRule{.unit = "m", .min = -10, .max = 10});
  v("subpixel", o.subpixel, px);
  v("noise", o.noise, px);
  v("min_range", o.min_range, range);
  v("max_range", o.max_range, range);
  v("max_disparity", o.max_disparity, FieldRule{.unit = "px", .min = 0, .max = 16384});
  v("occlusion", o.occlusion, FieldRule{});
  v("edge_loss", o.edge_loss, px);
  v("half_signal", o.half_signal, FieldRule{.min = 0, .max = 1000});
  v("seed", o.seed, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, EventOptions& o) {
  v("threshold", o.threshold, FieldRule{.min = 0.01, .max = 10});
  v("mismatch", o.mismatch, FieldRule{.min = 0, .max = 10});
  v("refractory", o.refractory, FieldRule{.unit = "s", .min = 0, .max = 1000});
  v("noise_rate", o.noise_rate, FieldRule{.unit = "Hz", .min = 0, .max = 1e4});
  v("dark", o.dark, FieldRule{.min = 1e-6, .max = 1});
  v("seed", o.seed, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, ThermalOptions& o) {
  const FieldRule noise{.unit = "K", .min = 0, .max = 100};
  const FieldRule temperature{.unit = "K", .min = 0, .max = 5000};
  v("netd", o.netd, noise);
  v("fixed_pattern", o.fixed_pattern, noise);
  v("step", o.step, noise);
  v("min", o.min, temperature);
  v("max", o.max, temperature);
  v("seed", o.seed, FieldRule{});
}

template <class Visitor>
void visit_sensing(Visitor& v, CameraSensing& o) {
  v("imager", o.imager, FieldRule{});
  v("timing", o.timing, FieldRule{});
  v("stereo_depth", o.stereo_depth, FieldRule{});
  v("events", o.events, FieldRule{});
  v("thermal", o.thermal, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, TemperatureOptions& o) {
  const FieldRule temperature{.unit = "K", .min = 1, .max = 5000};
  v("body", o.body, FieldRule{});
  v("material", o.material, FieldRule{});
  v("temperature", o.temperature, temperature);
  v("emissivity", o.emissivity, kShare);
  v("ambient", o.ambient, temperature);
}

template <class Visitor>
void visit_fields(Visitor& v, SensorOptions& o) {
  const FieldRule size{.min = 0, .max = 1e9};
  v("match", o.match, FieldRule{.required = true});
  v("preset", o.preset, FieldRule{.choices = words(kSignalPresets)});
  v("rate", o.rate, FieldRule{.unit = "Hz", .min = 0, .max = kFastestRate, .open = true});
  v("timing", o.timing, FieldRule{});
  v("noise", o.noise, size);
  v("noise_density", o.noise_density, size);
  v("bias_instability", o.bias_instability, size);
  v("random_walk", o.random_walk, size);
  v("bias", o.bias, size);
  v("offset", o.offset, FieldRule{.min = -1e9, .max = 1e9});
  v("scale_error", o.scale_error, kShare);
  v("range", o.range, size);
  v("resolution", o.resolution, size);
  v("seed", o.seed, FieldRule{});
}

}  // namespace gloam
