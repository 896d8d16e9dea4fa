#include "sensors/imager/exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gloam {
namespace {

constexpr double kMeterConstant = 12.5;  // K of ISO 2720 [cd s/(m² lx)]
constexpr int kMeterZone = 2;            // side [px]

}  // namespace

double Exposure::ev100() const { return std::log2(f_number * f_number / shutter * 100 / iso); }

Exposure exposure_at(double ev100, double f_number) {
  return {f_number, f_number * f_number * std::exp2(-ev100), 100};
}

Exposure program_exposure(double ev100, double f_number, const AutoExposureOptions& options) {
  Exposure exposure = exposure_at(ev100, f_number);
  if (exposure.shutter > options.max_shutter) {
    exposure.iso = std::min(100 * exposure.shutter / options.max_shutter, options.max_iso);
    exposure.shutter = options.max_shutter;
  }
  return exposure;
}

void AutoExposure::meter(double luminance, double time) {
  constexpr double kDarkest = 1e-6;  // [cd/m²]
  const double target = std::clamp(
      std::log2(std::max(luminance, kDarkest) * 100 / kMeterConstant) - options_.compensation,
      options_.min_ev100, options_.max_ev100);
  if (!started_ || time < time_) {
    ev100_ = target;
  } else {
    ev100_ += (target - ev100_) * -std::expm1((time_ - time) / options_.time_constant);
  }
  started_ = true;
  time_ = time;
}

double saturation_of(const AutoExposureOptions& options) {
  constexpr double kTopOfScale = 1.2;  // [cd/m²] at EV 0
  return kTopOfScale * 100 / kMeterConstant * std::exp2(-options.compensation);
}

double metered_luminance(const float* radiance, const MeterImage& image) {
  const int columns = (image.width + kMeterZone - 1) / kMeterZone;
  const int rows = (image.height + kMeterZone - 1) / kMeterZone;
  std::vector<double> light(static_cast<size_t>(columns * rows)), weight(light.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, radiance += 3) {
      const double dx = (x + 0.5 - 0.5 * image.width) / (0.25 * image.width),
                   dy = (y + 0.5 - 0.5 * image.height) / (0.25 * image.width);
      const double value = 0.2126 * static_cast<double>(radiance[0]) +
                           0.7152 * static_cast<double>(radiance[1]) +
                           0.0722 * static_cast<double>(radiance[2]);
      if (!std::isfinite(value)) continue;
      const double w = image.center_weighted ? std::exp(-0.5 * (dx * dx + dy * dy)) : 1;
      const auto zone = static_cast<size_t>(y / kMeterZone * columns + x / kMeterZone);
      light[zone] += w * value;
      weight[zone] += w;
    }
  }
  const auto mean_below = [&](double most) {
    double sum = 0, weights = 0;
    for (size_t i = 0; i < light.size(); ++i) {
      sum += std::min(light[i], weight[i] * most);
      weights += weight[i];
    }
    return weights > 0 ? sum / weights : 0;
  };
  // The mean falls from step to step to the one whose own exposure saturates as it supposes.
  constexpr double kTolerance = 1e-5;
  constexpr int kMostSteps = 200;
  double mean = mean_below(std::numeric_limits<double>::infinity());
  for (int k = 0; k < kMostSteps; ++k) {
    const double next = mean_below(image.saturation * mean);
    const bool settled = next >= (1 - kTolerance) * mean;
    mean = next;
    if (settled) break;
  }
  return mean;
}

}  // namespace gloam
