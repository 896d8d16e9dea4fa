#include "sensors/signal/draw.h"

#include <array>
#include <cmath>

namespace gloam {
namespace {

// log(k!), by Stirling's series from 10 on (error below 1e-10). std::lgamma writes a global.
double log_factorial(double k) {
  static constexpr std::array<double, 10> kSmall = {0,
                                                    0,
                                                    0.69314718055994531,
                                                    1.79175946922805500,
                                                    3.17805383034794562,
                                                    4.78749174278204599,
                                                    6.57925121201010100,
                                                    8.52516136106541430,
                                                    10.6046029027452502,
                                                    12.8018274800814696};
  if (k < 10) return kSmall[static_cast<size_t>(k)];
  const double n = k + 1, r = 1 / n, r2 = r * r;
  constexpr double kHalfLogTwoPi = 0.91893853320467274;
  return (n - 0.5) * std::log(n) - n + kHalfLogTwoPi +
         r * (1.0 / 12 - r2 * (1.0 / 360 - r2 * (1.0 / 1260 - r2 / 1680)));
}

double poisson_by_inversion(double uniform, double mean) {
  double p = std::exp(-mean), sum = p;
  int k = 0;
  while (uniform >= sum && k < 100) {  // beyond 100 the sum no longer grows
    p *= mean / ++k;
    sum += p;
  }
  return k;
}

}  // namespace

std::pair<double, double> normal_pair(const Philox4& bits) {
  constexpr double kTwoPi = 6.283185307179586;
  const double u = 1 - uniform_double(bits.v[0], bits.v[1]);  // (0, 1]
  const double angle = kTwoPi * uniform_double(bits.v[2], bits.v[3]);
  const double radius = std::sqrt(-2 * std::log(u));
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

double draw_normal(const RandomStream& stream, uint64_t counter, uint32_t index) {
  return normal_pair(stream.draw(counter, index)).first;
}

double draw_poisson(const RandomStream& stream, uint64_t counter, uint32_t index, double mean) {
  if (!(mean > 0)) return 0;
  if (mean < 10) return poisson_by_inversion(stream.uniform(counter, index), mean);
  const double b = 0.931 + 2.53 * std::sqrt(mean), a = -0.059 + 0.02483 * b;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4), v_r = 0.9277 - 3.6224 / (b - 2);
  for (uint64_t attempt = 0;; ++attempt) {
    const Philox4 bits = stream.draw(counter | attempt << 48, index);
    const double u = uniform_double(bits.v[0], bits.v[1]) - 0.5;
    const double v = uniform_double(bits.v[2], bits.v[3]);
    const double us = 0.5 - std::abs(u);
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= v_r) return k;
    if (k < 0 || (us < 0.013 && v > us)) continue;
    if (std::log(v) + std::log(inverse_alpha) - std::log(a / (us * us) + b) <=
        k * std::log(mean) - mean - log_factorial(k)) {
      return k;
    }
  }
}

}  // namespace gloam
