#include "world/materials/spectrum.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

/// Means over 10 nm from 380 nm on [W/m²/nm].
constexpr int kBins = 34;
constexpr double kSolarIrradiance[kBins] = {
    1.01249, 1.14716, 1.72765, 1.73054, 1.68870, 1.61253, 1.91198, 2.03474, 2.02042,
    2.02212, 1.93377, 1.95809, 1.91686, 1.82980, 1.86850, 1.89310, 1.85149, 1.85040,
    1.83410, 1.83450, 1.81470, 1.78158, 1.75330, 1.69650, 1.68194, 1.64654, 1.60480,
    1.52143, 1.55622, 1.51130, 1.47400, 1.44820, 1.41018, 1.36775};
/// Means over 10 nm from 380 nm on [1e-26 m²].
constexpr double kOzone[2 * kBandCount] = {
    0.02818, 0.06636, 0.1527, 0.2763, 0.552, 0.8451, 1.582, 2.316, 3.669, 4.924, 7.752,
    9.016,   14.8,    16.02,  21.39,  27.55, 30.91,  35.0,  42.66, 46.72, 43.98, 47.01,
    50.19,   43.05,   37.4,   32.15,  26.62, 22.38,  18.52, 14.73, 12.09, 9.423};

double lobe(double x, double mean, double below, double above) {
  const double t = (x - mean) / (x < mean ? below : above);
  return std::exp(-0.5 * t * t);
}

/// [lm/W] at 555 nm: the candela's definition.
constexpr double kLuminousEfficacy = 683;

/// Tristimulus values of the whole sun in each band.
std::array<Xyz, kBandCount> band_tristimulus() {
  std::array<Xyz, kBandCount> bands;
  for (int bin = 0; bin < kBins; ++bin) {
    Xyz& band = bands[std::min(bin / 2, kBandCount - 1)];
    for (int nm = 0; nm < 10; ++nm) {
      const Xyz m = color_matching(380.5 + 10 * bin + nm);
      const double watts = kLuminousEfficacy * kSolarIrradiance[bin];
      band.x += watts * m.x, band.y += watts * m.y, band.z += watts * m.z;
    }
  }
  return bands;
}

}  // namespace

Xyz color_matching(double nm) {
  return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
              0.065 * lobe(nm, 501.1, 20.4, 26.2),
          0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
          1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

std::array<double, 3> rec709_of(Xyz color) {
  const auto [x, y, z] = color;
  return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
          -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
          0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

Vec3f color_of_xyz(Xyz color) {
  const double y = color.y;
  const std::array<double, 3> rgb = rec709_of(color);
  const double least = std::min({rgb[0], rgb[1], rgb[2]});
  const double keep = least < 0 && y > 0 ? y / (y - least) : 1;
  const auto channel = [&](double c) {
    return static_cast<float>(std::max(0.0, y + keep * (c - y)));
  };
  return {channel(rgb[0]), channel(rgb[1]), channel(rgb[2])};
}

Vec3f color_of_sunlight(const Bands& share) {
  static const std::array<Xyz, kBandCount> tristimulus = band_tristimulus();
  double x = 0, y = 0, z = 0;
  for (int i = 0; i < kBandCount; ++i) {
    x += share[i] * tristimulus[i].x, y += share[i] * tristimulus[i].y;
    z += share[i] * tristimulus[i].z;
  }
  return color_of_xyz({x, y, z});
}

double rayleigh_cross_section(double wavelength) {
  const double um2 = wavelength * wavelength * 1e-6;  // [µm²]
  // Refractive index at 288.15 K and 1013.25 hPa, and the number of molecules there [1/m³].
  const double n =
      1 + 1e-8 * (8060.51 + 2480990 / (132.274 - 1 / um2) + 17455.7 / (39.32957 - 1 / um2));
  const double density = 2.546899e25, n2 = n * n;
  // King factor of nitrogen, oxygen, argon and carbon dioxide by volume.
  const double nitrogen = 1.034 + 3.17e-4 / um2;
  const double oxygen = 1.096 + 1.385e-3 / um2 + 1.448e-4 / (um2 * um2);
  const double king = (78.084 * nitrogen + 20.946 * oxygen + 0.934 + 0.036 * 1.15) / 100.0;
  const double lambda = wavelength * 1e-9;
  const double ratio = (n2 - 1) / (n2 + 2);
  return 24 * M_PI * M_PI * M_PI * ratio * ratio * king /
         (lambda * lambda * lambda * lambda * density * density);
}

double ozone_cross_section(int band) { return 0.5e-26 * (kOzone[2 * band] + kOzone[2 * band + 1]); }

}  // namespace gloam
