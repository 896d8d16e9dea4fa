#include "sensors/thermal/thermal_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gloam {
namespace {

constexpr double kStefanBoltzmann = 5.670374419e-8;  // [W/(m² K⁴)]
constexpr double kSecond = 1.438776877e4;            // c2 [µm K]
constexpr double kShort = 8, kLong = 14;             // [µm]
constexpr double kHottest = 6000;                    // [K]

// Share of a black body's radiance below `wavelength` [µm].
double share_below(double wavelength, double temperature) {
  const double x = kSecond / (wavelength * temperature);
  const double once = std::exp(-x);
  double sum = 0, power = once;
  for (int n = 1; n <= 500; ++n, power *= once) {
    const double r = 1.0 / n;
    const double term = power * r * (x * x * x + r * (3 * x * x + r * (6 * x + r * 6)));
    sum += term;
    if (term < 1e-13 * sum) break;
  }
  constexpr double kPi4 = 97.40909103400244;
  return 15 / kPi4 * sum;
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
  return std::clamp(t, i, i + 1);
}

}  // namespace gloam
