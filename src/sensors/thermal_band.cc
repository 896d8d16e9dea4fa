#include "sensors/thermal_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gloam {
namespace {

constexpr double kStefanBoltzmann = 5.670374419e-8;  // [W/(m² K⁴)]
constexpr double kSecond = 1.438776877e4;            // c2 [µm K]
constexpr double kShort = 8, kLong = 14;             // [µm]
constexpr double kHottest = 6000;                    // [K]

// Share of a black body's radiance below `wavelength` [µm].
double share_below(double wavelength, double temperature) {
  const double x = kSecond / (wavelength * temperature);
  double sum = 0;
  for (int n = 1; n <= 500; ++n) {
    const double i = n;
    const double term = std::exp(-i * x) * (x * x * x / i + 3 * x * x / (i * i) +
                                            6 * x / (i * i * i) + 6 / (i * i * i * i));
    sum += term;
    if (term < 1e-13 * sum) break;
  }
  return 15 / std::pow(std::numbers::pi, 4) * sum;
}

std::vector<double> make_table() {
  std::vector<double> table;
  for (int t = 0; t <= static_cast<int>(kHottest); ++t) table.push_back(thermal_radiance(t));
  return table;
}

}  // namespace

double thermal_radiance(double temperature) {
  if (!(temperature > 1)) return 0;
  const double t = std::min(temperature, kHottest);
  return kStefanBoltzmann * t * t * t * t / std::numbers::pi *
         (share_below(kLong, t) - share_below(kShort, t));
}

double apparent_temperature(double radiance) {
  static const std::vector<double> table = make_table();  // per kelvin
  if (!(radiance > table[2])) return 0;
  if (radiance >= table.back()) return kHottest;
  const auto above = std::upper_bound(table.begin(), table.end(), radiance);
  const auto i = static_cast<double>(above - table.begin()) - 1;
  const double low = *(above - 1), slope = *above - low;
  double t = i + (radiance - low) / slope;
  t -= (thermal_radiance(t) - radiance) / slope;  // the slope hardly changes within a kelvin
  t -= (thermal_radiance(t) - radiance) / slope;
  return std::clamp(t, i, i + 1);
}

}  // namespace gloam
