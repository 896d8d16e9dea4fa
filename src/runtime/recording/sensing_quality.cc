#include "runtime/recording/sensing_quality.h"

#include <cmath>
#include <cstddef>

namespace gloam {

double contrast_of(const std::vector<float>& radiance, int width) {
  const size_t n = radiance.size() / 3, across = static_cast<size_t>(width);
  std::vector<double> y(n);
  double mean = 0;
  for (size_t i = 0; i < n; ++i) {
    y[i] = 0.2126 * static_cast<double>(radiance[3 * i]) +
           0.7152 * static_cast<double>(radiance[3 * i + 1]) +
           0.0722 * static_cast<double>(radiance[3 * i + 2]);
    mean += y[i] / static_cast<double>(n);
  }
  for (double& value : y) value = std::log(value + 0.01 * mean);
  constexpr size_t kPixelSpacing = 4;
  double square = 0;
  size_t count = 0;
  for (size_t i = 0; i + kPixelSpacing * across < n; ++i) {
    if (i % across + kPixelSpacing >= across) continue;
    square += (y[i + kPixelSpacing] - y[i]) * (y[i + kPixelSpacing] - y[i]);
    square += (y[i + kPixelSpacing * across] - y[i]) * (y[i + kPixelSpacing * across] - y[i]);
    count += 2;
  }
  return std::sqrt(square / static_cast<double>(count));
}

ReturnShares returns_of(const LidarScan& scan) {
  ReturnShares out;
  for (size_t i = 0; i < scan.part.size(); ++i) {
    if (scan.return_number[i] == 0) (scan.part[i] == 0 ? out.media : out.surfaces) += 1;
  }
  return {out.surfaces / scan.beams, out.media / scan.beams};
}

}  // namespace gloam
