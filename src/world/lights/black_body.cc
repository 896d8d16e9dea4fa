#include "world/lights/black_body.h"

#include <algorithm>
#include <cmath>

#include "world/materials/spectrum.h"

namespace gloam {
namespace {

/// Spectral radiance [W/m²/sr/nm] by Planck's law.
double planck(double nm, double temperature) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  const double wavelength = nm * 1e-9;
  return 1e-9 * 2 * h * c * c / std::pow(wavelength, 5) /
         std::expm1(h * c / (wavelength * k * temperature));
}

}  // namespace

Vec3f black_body_luminance(double temperature) {
  Xyz sum;
  for (int nm = 360; nm <= 830; ++nm) {
    constexpr double kEfficacy = 683.002;  // [lm/W], CIE 018:2019
    const double power = kEfficacy * planck(nm, temperature);
    const Xyz m = color_matching(nm);
    sum.x += power * m.x, sum.y += power * m.y, sum.z += power * m.z;
  }
  std::array<double, 3> rgb = rec709_of(sum);
  for (double& channel : rgb) channel = std::max(channel, 0.0);
  const double scale = sum.y / (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
  return {static_cast<float>(rgb[0] * scale), static_cast<float>(rgb[1] * scale),
          static_cast<float>(rgb[2] * scale)};
}

}  // namespace gloam
