#pragma once
// Samplers of directions against their densities.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/rng.h"
#include "render/kernel/bsdf/layered_bsdf.h"

namespace gloam {

/// Chi-square test of `sample` (directions; false = none) against `pdf` per solid angle on a grid
/// of the sphere. Also checks that the density integrates to the share of samples that exist.
inline void check_directions(const std::function<bool(uint32_t, Vec3f*)>& sample,
                             const std::function<double(Vec3f)>& pdf, const char* name) {
  constexpr int kRows = 16, kColumns = 32, kFine = 12, kDraws = 200000;
  std::vector<double> expected(kRows * kColumns), observed(kRows * kColumns);
  double integral = 0;
  for (int row = 0; row < kRows * kFine; ++row) {
    for (int column = 0; column < kColumns * kFine; ++column) {
      const float z = -1 + 2 * (row + 0.5f) / (kRows * kFine);
      const float phi = 2 * kPi * (column + 0.5f) / (kColumns * kFine), r = std::sqrt(1 - z * z);
      const double share = pdf({r * std::cos(phi), r * std::sin(phi), z}) * 4 * kPi /
                           (kRows * kColumns * kFine * kFine);
      expected[row / kFine * kColumns + column / kFine] += share * kDraws;
      integral += share;
    }
  }
  int made = 0;
  for (uint32_t i = 0; i < kDraws; ++i) {
    Vec3f d;
    if (!sample(i, &d)) continue;
    ++made;
    EXPECT_NEAR(length(d), 1, 1e-4) << name;
    double phi = std::atan2(d.y, d.x);
    if (phi < 0) phi += 2 * kPi;
    const int row = std::min(kRows - 1, static_cast<int>((d.z + 1) * 0.5 * kRows));
    const int column = std::min(kColumns - 1, static_cast<int>(phi / (2 * kPi) * kColumns));
    observed[row * kColumns + column] += 1;
  }
  EXPECT_NEAR(integral, static_cast<double>(made) / kDraws, 0.01) << name;
  double chi2 = 0, pooled_expected = 0, pooled_observed = 0;
  int cells = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    pooled_expected += expected[i];
    pooled_observed += observed[i];
    if (pooled_expected < 50) continue;
    // The grid integrates the density to about 1 %: that is not the sampler's error.
    const double gap =
        std::max(0.0, std::abs(pooled_observed - pooled_expected) - 0.01 * pooled_expected);
    chi2 += gap * gap / pooled_expected;
    pooled_expected = pooled_observed = 0;
    ++cells;
  }
  EXPECT_LT(chi2, cells + 5 * std::sqrt(2.0 * cells)) << name << " over " << cells << " cells";
}

/// The sampler that chi-square tests draw from: independent points, as the test assumes.
inline Vec2f random_2d(uint32_t i, uint32_t k) {
  const Philox4 d = philox4x32(99, k, i);
  return {uniform_float(d.v[0]), uniform_float(d.v[1])};
}

/// Directions of sample_bsdf compared with eval_bsdf, for a Bsdf or a LayeredBsdf.
template <class B>
void check_bsdf(const B& bsdf, Vec3f wo, const std::string& name) {
  check_directions(
      [&](uint32_t i, Vec3f* d) {
        const BsdfSample s = sample_bsdf(bsdf, wo, random_2d(i, 1).x, random_2d(i, 0));
        *d = s.wi;
        if (s.pdf <= 0) return false;
        float pdf = 0;
        const Vec3f f = eval_bsdf(bsdf, wo, s.wi, &pdf);
        EXPECT_FLOAT_EQ(pdf, s.pdf);
        EXPECT_NEAR(f.x, s.weight.x * pdf, 1e-4f * (1 + f.x));
        return true;
      },
      [&](Vec3f d) {
        float pdf = 0;
        eval_bsdf(bsdf, wo, d, &pdf);
        return pdf;
      },
      name.c_str());
}

}  // namespace gloam
