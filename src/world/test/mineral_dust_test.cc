// The medium "dust": Mie theory of measured refractive indices and sizes must give its table.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include "world/media/medium_presets.h"

namespace gloam {
namespace {

using Complex = std::complex<double>;

struct Efficiencies {
  double extinction = 0, scattering = 0, g = 0;
};

// Sphere of size parameter x and refractive index m: Bohren and Huffman 1983, "Absorption and
// scattering of light by small particles", 4.4.2 and 4.8.
Efficiencies mie(double x, Complex m) {
  const Complex mx = m * x;
  const int last = static_cast<int>(x + 4.05 * std::cbrt(x) + 2);
  const int start = std::max(last, static_cast<int>(std::abs(mx))) + 16;
  std::vector<Complex> d(static_cast<size_t>(start) + 1);  // logarithmic derivatives
  for (int n = start; n > 1; --n) {
    const Complex ratio = static_cast<double>(n) / mx;
    d[static_cast<size_t>(n - 1)] = ratio - 1.0 / (d[static_cast<size_t>(n)] + ratio);
  }
  double psi0 = std::cos(x), psi1 = std::sin(x), chi0 = -std::sin(x), chi1 = std::cos(x);
  Complex a_before, b_before;
  Efficiencies q;
  for (int n = 1; n <= last; ++n) {
    const double k = 2 * n + 1;
    const double psi = (k - 2) * psi1 / x - psi0, chi = (k - 2) * chi1 / x - chi0;
    const Complex xi(psi, -chi), xi1(psi1, -chi1), dn = d[static_cast<size_t>(n)];
    const Complex u = dn / m + n / x, v = m * dn + n / x;
    const Complex a = (u * psi - psi1) / (u * xi - xi1), b = (v * psi - psi1) / (v * xi - xi1);
    q.extinction += k * (a + b).real();
    q.scattering += k * (std::norm(a) + std::norm(b));
    q.g += k / (n * (n + 1.0)) * (a * std::conj(b)).real();
    if (n > 1) {
      q.g += (n - 1.0) * (n + 1.0) / n * (a_before * std::conj(a) + b_before * std::conj(b)).real();
    }
    a_before = a;
    b_before = b;
    psi0 = psi1;
    psi1 = psi;
    chi0 = chi1;
    chi1 = chi;
  }
  q.g *= 2 / q.scattering;
  q.extinction *= 2 / (x * x);
  q.scattering *= 2 / (x * x);
  return q;
}

double interpolate(std::span<const std::array<double, 2>> table, double x) {
  size_t i = 1;
  while (i + 1 < table.size() && x > table[i][0]) ++i;
  const double t = std::clamp((x - table[i - 1][0]) / (table[i][0] - table[i - 1][0]), 0.0, 1.0);
  return table[i - 1][1] + t * (table[i][1] - table[i - 1][1]);
}

// Wavelengths [µm]: Di Biagio et al. 2019, table 4; OPAC's "mineral".
constexpr std::array<double, 2> kVisible[] = {{0.37, 0.0033}, {0.47, 0.0024}, {0.52, 0.0018},
                                              {0.59, 0.0012}, {0.66, 0.0010}, {0.88, 0.0009},
                                              {0.95, 0.0009}};
constexpr std::array<double, 2> kRealFar[] = {
    {7.9, 1.22},  {8.2, 1.12},  {8.5, 1.06},  {8.7, 1.19}, {9.0, 1.85},
    {9.2, 2.22},  {9.5, 2.94},  {9.8, 2.91},  {10, 2.57},  {10.6, 1.91},
    {11.0, 1.83}, {11.5, 1.81}, {12.5, 1.74}, {13, 2.0},   {14, 1.63}};
constexpr std::array<double, 2> kImaginaryFar[] = {
    {7.9, 0.089}, {8.2, 0.12},  {8.5, 0.21}, {8.7, 0.29}, {9.0, 0.44},
    {9.2, 0.54},  {9.5, 0.65},  {9.8, 0.65}, {10, 0.5},   {10.6, 0.25},
    {11.0, 0.2},  {11.5, 0.35}, {12.5, 0.5}, {13, 0.35},  {14, 0.22}};

struct Bulk {
  double extinction = 0;  // [m²/kg]
  double albedo = 0, g = 0;
};

/// Mean over wavelengths [µm] of grains whose volume is log-normal in their radius.
Bulk bulk(std::span<const double> wavelengths, bool is_far) {
  constexpr double radius = 1.90, spread = 0.60, density = 2600;  // [µm], of its logarithm, [kg/m³]
  constexpr int classes = 600;
  double volume = 0, extinction = 0, scattering = 0, forward = 0;
  for (const double wavelength : wavelengths) {
    const Complex m =
        is_far ? Complex(interpolate(kRealFar, wavelength), interpolate(kImaginaryFar, wavelength))
               : Complex(1.52, interpolate(kVisible, wavelength));
    for (int i = 0; i < classes; ++i) {
      const double r = 0.03 * std::pow(15 / 0.03, i / (classes - 1.0));
      const double v = std::exp(-0.5 * std::pow(std::log(r / radius) / spread, 2));
      const Efficiencies q = mie(2 * M_PI * r / wavelength, m);
      const double area = 0.75 * v / (1e-6 * r);
      volume += v;
      extinction += area * q.extinction;
      scattering += area * q.scattering;
      forward += area * q.scattering * q.g;
    }
  }
  return {extinction / volume / density, scattering / extinction, forward / scattering};
}

TEST(MineralDust, MieTheoryOfKnownSpheres) {
  // Table of Wiscombe 1979, "Mie scattering calculations", for x = 10 and m = 1.5.
  const Efficiencies q = mie(10, {1.5, 0});
  EXPECT_NEAR(q.extinction, 2.8820, 1e-3);
  EXPECT_NEAR(q.scattering, q.extinction, 1e-9);
  EXPECT_NEAR(q.g, 0.7429, 1e-3);
  // Small grains follow Rayleigh's law, 8/3 x⁴ |(m² - 1) / (m² + 2)|².
  const double x = 0.02;
  EXPECT_NEAR(mie(x, {1.5, 0}).scattering, 8.0 / 3 * std::pow(x, 4) * std::pow(1.25 / 4.25, 2),
              1e-3 * std::pow(x, 4));
  EXPECT_NEAR(mie(500, {1.5, 0.1}).extinction, 2, 0.04) << "twice the shadow";
}

TEST(MineralDust, TheTableIsWhatMeasuredIndicesAndSizesGive) {
  const MediumDescription& dust = *find_medium("dust");
  const double bands[] = {0.612, 0.550, 0.465, 0.905, 1.550};
  for (size_t i = 0; i < kMediumBands; ++i) {
    std::vector<double> wavelengths;
    for (int k = 0; k < 24; ++k) wavelengths.push_back(8.125 + 0.25 * k);
    const bool is_far = i == 5;
    if (!is_far) wavelengths = {bands[i]};
    const Bulk expected = bulk(wavelengths, is_far);
    EXPECT_NEAR(dust.mass_extinction[i] / expected.extinction, 1, 0.01) << i;
    EXPECT_NEAR(dust.albedo[i], expected.albedo, 0.003) << i;
    EXPECT_NEAR(dust.g[i], expected.g, 0.005) << i;
  }
}

TEST(MineralDust, ItIsAsBrightAsMeasuredAndRedderThanItsShadow) {
  const MediumDescription& dust = *find_medium("dust");
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_GE(dust.albedo[i], 0.90f);
    EXPECT_LE(dust.albedo[i], 0.97f);
  }
  EXPECT_GT(dust.albedo[0], dust.albedo[2]) << "iron oxides take blue";
}

}  // namespace
}  // namespace gloam
