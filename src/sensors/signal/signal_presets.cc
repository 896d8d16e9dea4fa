#include "sensors/signal/signal_presets.h"

#include <array>
#include <numbers>

#include "base/angle.h"
#include "scene/options/pattern_names.h"

namespace gloam {
namespace {

constexpr double kHour = 3600;
constexpr double kG = 9.80665, kMicroG = 1e-6 * kG, kMilliG = 1e-3 * kG;  // [m/s²]

// In the order of kSignalPresets.
constexpr std::array<SignalErrors, kSignalPresets.size()> kErrorsOfPresets = {{
    {},
    {.noise_density = 0.008 * kDegree,
     .bias_instability = 8 * kDegree / kHour,
     .range = 2000 * kDegree},
    {.noise_density = 100 * kMicroG, .bias_instability = 13 * kMicroG, .range = 40 * kG},
    {.noise_density = 0.014 * kDegree,
     .bias = 1 * kDegree,
     .range = 2000 * kDegree,
     .resolution = kDegree / 16.384},
    {.noise_density = 175 * kMicroG,
     .bias = 20 * kMilliG,
     .range = 24 * kG,
     .resolution = 24 * kG / 32768},
    {.noise_density = 0.005 * kDegree,
     .bias = 20 * kDegree / 3,
     .scale_error = 0.01,
     .range = 250 * kDegree,
     .resolution = kDegree / 131},
    {.noise_density = 400 * kMicroG,
     .bias = 50 * kMilliG / 3,
     .scale_error = 0.01,
     .range = 2 * kG,
     .resolution = kG / 16384},
    {.noise = 0.06 * kDegree, .resolution = 2 * std::numbers::pi / 16384},
}};

}  // namespace

SignalErrors signal_errors(const SensorOptions& o) {
  const SignalErrors& preset = kErrorsOfPresets[place_of(o.preset, kSignalPresets)];
  SignalErrors out;
  out.noise = o.noise.value_or(preset.noise);
  out.noise_density = o.noise_density.value_or(preset.noise_density);
  out.bias_instability = o.bias_instability.value_or(preset.bias_instability);
  out.random_walk = o.random_walk.value_or(preset.random_walk);
  out.bias = o.bias.value_or(preset.bias);
  out.offset = o.offset.value_or(preset.offset);
  out.scale_error = o.scale_error.value_or(preset.scale_error);
  out.range = o.range.value_or(preset.range);
  out.resolution = o.resolution.value_or(preset.resolution);
  return out;
}

}  // namespace gloam
