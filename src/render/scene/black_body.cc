#include "render/scene/black_body.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

/// Gaussian of different width on either side.
double lobe(double x, double center, double left, double right) {
  const double t = (x - center) / (x < center ? left : right);
  return std::exp(-0.5 * t * t);
}

/// Spectral radiance [W / (m² sr m)] by Planck's law.
double planck(double wavelength, double temperature) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  return 2 * h * c * c / std::pow(wavelength, 5) /
         std::expm1(h * c / (wavelength * k * temperature));
}

}  // namespace

Vec3f black_body_luminance(double temperature) {
  double X = 0, Y = 0, Z = 0;
  for (int nm = 360; nm <= 830; ++nm) {
    const double radiance = planck(nm * 1e-9, temperature) * 1e-9;
    X += radiance * (1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
                     0.065 * lobe(nm, 501.1, 20.4, 26.2));
    Y += radiance * (0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1));
    Z += radiance * (1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8));
  }
  constexpr double kEfficacy = 683.002;  // [lm/W], CIE 018:2019
  // XYZ to linear Rec. 709 (IEC 61966-2-1).
  double rgb[3] = {3.2406255 * X - 1.5372080 * Y - 0.4986286 * Z,
                   -0.9689307 * X + 1.8757561 * Y + 0.0415175 * Z,
                   0.0557101 * X - 0.2040211 * Y + 1.0569959 * Z};
  for (double& v : rgb) v = std::max(v, 0.0);
  const double shown = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  const double scale = kEfficacy * Y / shown;
  return {static_cast<float>(rgb[0] * scale), static_cast<float>(rgb[1] * scale),
          static_cast<float>(rgb[2] * scale)};
}

std::vector<Vec3f> make_black_body_table() {
  constexpr double low = 1.0 / BlackBodyTable::kLow, high = 1.0 / BlackBodyTable::kHigh;
  std::vector<Vec3f> table(BlackBodyTable::kSize);
  for (int i = 0; i < BlackBodyTable::kSize; ++i) {
    table[i] = black_body_luminance(1 / (low + (high - low) * i / (BlackBodyTable::kSize - 1)));
  }
  return table;
}

}  // namespace gloam
