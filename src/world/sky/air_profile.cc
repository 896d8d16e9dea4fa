#include "world/sky/air_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gloam {
namespace {

constexpr double kSpacing = 5e3;  // [m]
constexpr int kLevels = 21;
/// [kg/m³]
constexpr std::array<double, kLevels> kDensity = {
    1.2250,   0.73643,  0.41351,  0.19476,  0.088910, 0.040084, 0.018410,
    8.463e-3, 3.996e-3, 1.966e-3, 1.027e-3, 5.681e-4, 3.097e-4, 1.632e-4,
    8.283e-5, 3.992e-5, 1.846e-5, 8.220e-6, 3.416e-6, 1.393e-6, 5.604e-7};

std::array<double, kLevels> log_shares() {
  std::array<double, kLevels> logs;
  for (int i = 0; i < kLevels; ++i) logs[i] = std::log(kDensity[i] / kDensity[0]);
  return logs;
}

}  // namespace

Densities densities(double radius) {
  static const std::array<double, kLevels> logs = log_shares();
  const double height = radius - kEarthRadius;
  const double x = std::clamp(height / kSpacing, 0.0, kLevels - 1.0);
  const int low = std::min(static_cast<int>(x), kLevels - 2);
  return {std::exp(logs[low] + (x - low) * (logs[low + 1] - logs[low])),
          std::exp(-height / kAerosolColumn),
          std::max(0.0, 1 - std::abs(height - 25e3) / kOzoneColumn)};
}

}  // namespace gloam
