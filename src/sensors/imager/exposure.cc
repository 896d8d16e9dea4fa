#include "sensors/imager/exposure.h"

#include <algorithm>
#include <cmath>

namespace gloam {

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
  constexpr double kMeterConstant = 12.5, kDarkest = 1e-6;  // [cd/m²]
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

double metered_luminance(const float* radiance, int width, int height, bool center_weighted) {
  double sum = 0, weights = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, radiance += 3) {
      const double dx = (x + 0.5 - 0.5 * width) / (0.25 * width),
                   dy = (y + 0.5 - 0.5 * height) / (0.25 * width);
      const double weight = center_weighted ? std::exp(-0.5 * (dx * dx + dy * dy)) : 1;
      const double light = 0.2126 * static_cast<double>(radiance[0]) +
                           0.7152 * static_cast<double>(radiance[1]) +
                           0.0722 * static_cast<double>(radiance[2]);
      if (!std::isfinite(light)) continue;
      sum += weight * light;
      weights += weight;
    }
  }
  return weights > 0 ? sum / weights : 0;
}

}  // namespace gloam
