#include "world/weather/gusts.h"

#include <cmath>
#include <numbers>

#include "base/rng.h"
#include "base/wave_math.h"

namespace gloam {
namespace {

// Factors on the standard deviation: along, across, up
constexpr double kComponentFactors[3] = {1, 0.8, 0.5};
// Integral scales are 8.1, 2.7 and 0.66 of 0.7 times the height, here ten metres.
constexpr double kScales[3] = {8.1 * 7, 2.7 * 7, 0.66 * 7};  // [m]
constexpr double kSlowest = 1.0 / 600, kFastest = 5;         // [Hz]

// Share of Kaimal's variance below a frequency.
double variance_below(double frequency, double turnover) {
  return 1 - std::pow(1 + 6 * frequency * turnover, -2.0 / 3);
}

}  // namespace

Gusts::Gusts(const WindDescription& wind)
    : along_x_(wind.along_x), along_y_(wind.along_y), tones_{} {
  const RandomStream random{wind.seed, stream_id("wind.gusts")};
  const double ratio = std::pow(kFastest / kSlowest, 1.0 / kTones);
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const double turnover = kScales[axis] / wind.speed;  // [s]
    const double all = variance_below(kFastest, turnover) - variance_below(kSlowest, turnover);
    double low = kSlowest;
    for (uint32_t i = 0; i < kTones; ++i, low *= ratio) {
      const double share =
          (variance_below(low * ratio, turnover) - variance_below(low, turnover)) / all;
      Tone& tone = tones_[axis][i];
      tone.amplitude = kComponentFactors[axis] * wind.gusts * std::sqrt(2 * share);
      const double frequency = low * std::pow(ratio, random.uniform(i, 2 * axis));
      tone.omega = 2 * std::numbers::pi * frequency;
      tone.phase = 2 * std::numbers::pi * random.uniform(i, 2 * axis + 1);
    }
  }
}

Vec3 Gusts::to_world(const double* sum) const {
  return {sum[0] * along_x_ - sum[1] * along_y_, sum[0] * along_y_ + sum[1] * along_x_, sum[2]};
}

Vec3 Gusts::at(double time) const {
  double sum[3] = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    double part[kTones];
    for (size_t i = 0; i < kTones; ++i) {
      const Tone& tone = tones_[axis][i];
      part[i] = tone.amplitude * sin_cos(tone.omega * time + tone.phase).cos;
    }
    for (const double tone : part) sum[axis] += tone;
  }
  return to_world(sum);
}

Vec3 Gusts::carry(double time, double lag) const {
  double sum[3] = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const Tone& tone : tones_[axis]) {
      const double slow = tone.omega * lag, late = std::atan(slow);
      sum[axis] +=
          tone.amplitude / std::hypot(1, slow) * sin_cos(tone.omega * time + tone.phase - late).cos;
    }
  }
  return to_world(sum);
}

Vec3 Gusts::way(double time, double lag) const {
  double sum[3] = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const Tone& tone : tones_[axis]) {
      const double slow = tone.omega * lag, from = tone.phase - std::atan(slow);
      sum[axis] += tone.amplitude / std::hypot(1, slow) / tone.omega *
                   (sin_cos(tone.omega * time + from).sin - sin_cos(from).sin);
    }
  }
  return to_world(sum);
}

}  // namespace gloam
