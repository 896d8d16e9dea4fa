// Environment maps: look-ups, densities, samples, estimators.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/rng.h"
#include "render/scene/environment_table.h"

namespace gloam {
namespace {

const Frame kUpright{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

Vec2f random_2d(uint32_t i) {
  const Philox4 d = philox4x32(4711, 0, i);
  return {uniform_float(d.v[0]), uniform_float(d.v[1])};
}

Vec3f direction(double theta, double phi) {
  return {static_cast<float>(std::sin(theta) * std::cos(phi)),
          static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
}

EnvironmentTable table_of(int width, int height, const std::vector<Vec3f>& texels) {
  Result<EnvironmentTable> table = EnvironmentTable::make(width, height, texels, "map");
  EXPECT_TRUE(table.ok()) << table.error().to_string();
  return std::move(*table);
}

/// Random texels with dark blocks and a wide range.
std::vector<Vec3f> patchy(int width, int height) {
  std::vector<Vec3f> texels;
  for (int i = 0; i < width * height; ++i) {
    const Philox4 d = philox4x32(5, 1, static_cast<uint32_t>(i));
    const float bright = std::exp(4 * uniform_float(d.v[0])) * (d.v[1] % 3 == 0 ? 0.0f : 1.0f);
    texels.push_back({bright, bright * uniform_float(d.v[2]), bright * uniform_float(d.v[3])});
  }
  return texels;
}

/// Integral of f over the sphere by the midpoint rule: rows x 2 rows points.
template <class F>
double integrate(int rows, F f) {
  double sum = 0;
  for (int row = 0; row < rows; ++row) {
    const double theta = M_PI * (row + 0.5) / rows;
    double ring = 0;
    for (int column = 0; column < 2 * rows; ++column) {
      ring += f(direction(theta, M_PI * (column + 0.5) / rows));
    }
    sum += ring * std::sin(theta);
  }
  return sum * M_PI * M_PI / rows / rows;
}

TEST(Environment, LooksUpBilinearlyOverTheSeam) {
  // 36 rows: none are added. Columns from +X (the middle) by -Y.
  std::vector<Vec3f> texels(4 * 36);
  for (int i = 0; i < 4 * 36; ++i) texels[i] = {static_cast<float>(i % 4), 0, 1};
  const EnvironmentTable table = table_of(4, 36, texels);
  const EnvironmentView map = table.view(kUpright, 10);
  const auto at = [&](double degrees) {
    return environment_radiance(map, direction(M_PI / 2, degrees * M_PI / 180), 0).x;
  };
  EXPECT_NEAR(at(135), 0, 1e-4);
  EXPECT_NEAR(at(45), 10, 1e-4);
  EXPECT_NEAR(at(0), 15, 1e-4);
  EXPECT_NEAR(at(-45), 20, 1e-4);
  EXPECT_NEAR(at(-135), 30, 1e-4);
  // Between the last column and the first.
  EXPECT_NEAR(at(180), 15, 1e-4);
  EXPECT_NEAR(at(-180), 15, 1e-4);
  EXPECT_NEAR(at(179.99), 15, 0.01);
  EXPECT_NEAR(at(-179.99), 15, 0.01);
  EXPECT_NEAR(at(157.5), 7.5, 1e-3);
}

TEST(Environment, TurnsWithItsFrame) {
  const std::vector<Vec3f> texels = patchy(64, 40);
  const EnvironmentTable table = table_of(64, 40, texels);
  const EnvironmentView upright = table.view(kUpright, 1);
  const EnvironmentView turned = table.view(turned_about_z(0.5f), 1);
  const Frame tilted{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};  // E's X is the world's Z, and so on
  const EnvironmentView leaning = table.view(tilted, 1);
  for (uint32_t i = 0; i < 100; ++i) {
    const Vec2f u = random_2d(i);
    const double theta = std::acos(1 - 2 * u.x), phi = 2 * M_PI * u.y;
    const Vec3f d = direction(theta, phi);
    const Vec3f expected = environment_radiance(upright, d, 0);
    const float slack = 1e-3f * (1 + expected.x);
    EXPECT_NEAR(environment_radiance(turned, direction(theta, phi + 0.5), 0).x, expected.x, slack);
    EXPECT_NEAR(environment_radiance(leaning, {d.y, d.z, d.x}, 0).x, expected.x, slack);
    EXPECT_NEAR(environment_pdf(leaning, {d.y, d.z, d.x}), environment_pdf(upright, d),
                1e-3f * (0.01f + environment_pdf(upright, d)));
    const EnvironmentSample s = environment_sample(leaning, u);
    EXPECT_NEAR(s.pdf, environment_pdf(leaning, s.wi), 2e-3f * s.pdf);
    EXPECT_NEAR(s.radiance.x, environment_radiance(leaning, s.wi, 0).x, 2e-3f * (1 + s.radiance.x));
  }
}

TEST(Environment, DensityIsPositiveWhereLightIsAndIntegratesToOne) {
  struct Size {
    int width, height;
  };
  for (const Size size : {Size{64, 40}, Size{37, 33}, Size{5, 7}, Size{2, 2}, Size{1, 1}}) {
    SCOPED_TRACE(testing::Message() << size.width << " x " << size.height);
    const std::vector<Vec3f> texels =
        size.width > 1 ? patchy(size.width, size.height) : std::vector<Vec3f>{{0.2f, 0.7f, 1}};
    const EnvironmentTable table = table_of(size.width, size.height, texels);
    const EnvironmentView map = table.view(kUpright, 3);
    int bare = 0, dark = 0;
    const double integral = integrate(700, [&](Vec3f d) {
      const float pdf = environment_pdf(map, d);
      const float bright = luminance(environment_radiance(map, d, 0));
      bare += bright > 1e-5f && !(pdf > 0);
      dark += bright == 0;
      return pdf;
    });
    EXPECT_NEAR(integral, 1, 2e-3);
    EXPECT_EQ(bare, 0);
    if (size.width >= 37) {
      EXPECT_GT(dark, 0) << "no dark place put to the test";
    }
    EXPECT_NEAR(map.illuminance,
                integrate(700, [&](Vec3f d) { return luminance(environment_radiance(map, d, 0)); }),
                0.03 * map.illuminance);
  }
}

TEST(Environment, SamplesFollowTheDensity) {
  const std::vector<Vec3f> grey{{0.2f, 0.2f, 0.2f}};
  for (const int width : {64, 5, 1}) {
    const EnvironmentTable table =
        table_of(width, width / 2 + 1, width > 1 ? patchy(width, width / 2 + 1) : grey);
    const EnvironmentView map = table.view(turned_about_z(1), 1);
    constexpr int kRows = 20, kColumns = 40, kFine = 20, kDraws = 400000;
    std::vector<double> expected(kRows * kColumns), observed(kRows * kColumns);
    for (int row = 0; row < kRows * kFine; ++row) {
      for (int column = 0; column < kColumns * kFine; ++column) {
        const double z = 1 - 2 * (row + 0.5) / (kRows * kFine);
        const Vec3f d = direction(std::acos(z), 2 * M_PI * (column + 0.5) / (kColumns * kFine));
        expected[row / kFine * kColumns + column / kFine] +=
            environment_pdf(map, d) * 4 * M_PI / (kRows * kColumns * kFine * kFine) * kDraws;
      }
    }
    for (uint32_t i = 0; i < kDraws; ++i) {
      const EnvironmentSample s = environment_sample(map, random_2d(i));
      ASSERT_GT(s.pdf, 0);
      ASSERT_NEAR(length(s.wi), 1, 1e-5);
      const double phi = std::atan2(s.wi.y, s.wi.x);
      const int row = std::clamp(static_cast<int>((1 - s.wi.z) * 0.5 * kRows), 0, kRows - 1);
      const int column =
          std::clamp(static_cast<int>((phi < 0 ? phi + 2 * M_PI : phi) / (2 * M_PI) * kColumns), 0,
                     kColumns - 1);
      observed[row * kColumns + column] += 1;
    }
    double chi2 = 0, most = 0;
    int cells = 0;
    for (size_t i = 0; i < expected.size(); ++i) {
      if (expected[i] < 20) continue;
      // The grid integrates the density to about 1 %: that is not the sampler's error.
      const double gap = std::max(0.0, std::abs(observed[i] - expected[i]) - 0.01 * expected[i]);
      chi2 += gap * gap / expected[i];
      most = std::max(most, gap / std::sqrt(expected[i]));
      ++cells;
    }
    EXPECT_GT(cells, 200);
    EXPECT_LT(chi2, cells + 5 * std::sqrt(2.0 * cells)) << width;
    EXPECT_LT(most, 6) << width;
  }
}

struct Estimate {
  double mean, variance;
};
/// Of the integral of f(direction) times luminance, by samples of the map or evenly on the sphere.
template <class F>
Estimate estimate(const EnvironmentView& map, bool by_map, uint32_t draws, F f) {
  double sum = 0, squares = 0;
  for (uint32_t i = 0; i < draws; ++i) {
    const Vec2f u = random_2d(i);
    double x = 0;
    if (by_map) {
      const EnvironmentSample s = environment_sample(map, u);
      x = luminance(s.radiance) * f(s.wi) / s.pdf;
    } else {
      const Vec3f d = direction(std::acos(1 - 2.0 * u.x), 2 * M_PI * u.y);
      x = luminance(environment_radiance(map, d, 0)) * f(d) * 4 * M_PI;
    }
    sum += x;
    squares += x * x;
  }
  const double mean = sum / draws;
  return {mean, squares / draws - mean * mean};
}

TEST(Environment, EstimatesAreTheIntegral) {
  const EnvironmentTable table = table_of(48, 36, patchy(48, 36));
  const EnvironmentView map = table.view(turned_about_z(-2), 5);
  const auto lambert = [](Vec3f d) { return std::max(0.0f, 0.6f * d.x + 0.8f * d.z); };
  const double truth = integrate(
      1500, [&](Vec3f d) { return luminance(environment_radiance(map, d, 0)) * lambert(d); });
  constexpr uint32_t kDraws = 200000;
  for (const bool by_map : {false, true}) {
    const Estimate e = estimate(map, by_map, kDraws, lambert);
    EXPECT_NEAR(e.mean, truth, 4 * std::sqrt(e.variance / kDraws) + 1e-4 * truth) << by_map;
  }
}

TEST(Environment, OneBrightTexelIsFound) {
  std::vector<Vec3f> texels(512 * 256, Vec3f{1, 1, 1});
  texels[70 * 512 + 100] = {1e6f, 1e6f, 1e6f};
  const EnvironmentTable table = table_of(512, 256, texels);
  const EnvironmentView map = table.view(kUpright, 1);
  const auto all = [](Vec3f) { return 1.0; };
  // A tent of one texel's area, and 4 pi from the rest.
  const double texel = 2 * M_PI / 512 * (std::cos(M_PI * 70 / 256) - std::cos(M_PI * 71 / 256));
  const double truth = 1e6 * texel + 4 * M_PI;
  constexpr uint32_t kDraws = 100000;
  const Estimate e = estimate(map, true, kDraws, all), even = estimate(map, false, kDraws, all);
  EXPECT_NEAR(e.mean, truth, 1e-3 * truth);
  EXPECT_LT(std::sqrt(e.variance), 0.02 * truth);
  RecordProperty("variance_ratio", std::to_string(even.variance / e.variance));
  EXPECT_GT(even.variance / e.variance, 1e5);
  // With the bright texel hidden the rest has its own mean: dark texels beside it in the running
  // sums are drawn as often as the density says.
  const auto rest_of_row = [&](Vec3f d) {
    const Vec2f uv = environments::uv_of(d);
    return uv.y * 256 > 69 && uv.y * 256 < 72 && uv.x * 512 > 102 ? 1.0 : 0.0;
  };
  const double band =
      2 * M_PI * (1 - 102.0 / 512) * (std::cos(M_PI * 69 / 256) - std::cos(M_PI * 72 / 256));
  constexpr uint32_t kMany = 4000000;
  const Estimate rest = estimate(map, true, kMany, rest_of_row);
  EXPECT_NEAR(rest.mean, band, 4 * std::sqrt(rest.variance / kMany));
  EXPECT_LT(std::sqrt(rest.variance / kMany), 0.1 * band);
}

TEST(Environment, FaintTexelsBesideASunAreStillDrawn) {
  std::vector<Vec3f> texels(256 * 128, Vec3f{1e-6f, 1e-6f, 1e-6f});
  texels[40 * 256 + 3] = {1e12f, 1e12f, 1e12f};
  const EnvironmentTable table = table_of(256, 128, texels);
  const EnvironmentView map = table.view(kUpright, 1);
  for (uint32_t i = 0; i < 20000; ++i) {
    const Vec2f u = random_2d(i);
    const Vec3f d = direction(std::acos(1 - 2.0 * u.x), 2 * M_PI * u.y);
    ASSERT_GT(environment_pdf(map, d), 0);
  }
}

TEST(Environment, PolesAreSampledAndFinite) {
  std::vector<Vec3f> texels(64 * 40, Vec3f{0, 0, 0});
  for (int column = 0; column < 64; ++column) {
    texels[column] = {1, 1, 1};
    texels[39 * 64 + column] = {2, 2, 2};
  }
  const EnvironmentTable table = table_of(64, 40, texels);
  const EnvironmentView map = table.view(kUpright, 1);
  for (const float z : {1.0f, -1.0f}) {
    EXPECT_FLOAT_EQ(environment_radiance(map, {0, 0, z}, 0).x, z > 0 ? 1 : 2);
    EXPECT_GT(environment_pdf(map, {0, 0, z}), 0);
    EXPECT_TRUE(std::isfinite(environment_pdf(map, {0, 0, z})));
  }
  EXPECT_EQ(environment_pdf(map, {1, 0, 0}), 0);
  int above = 0;
  for (uint32_t i = 0; i < 30000; ++i) {
    const EnvironmentSample s = environment_sample(map, random_2d(i));
    ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf > 0);
    above += s.wi.z > 0;
  }
  EXPECT_NEAR(above / 30000.0, 1 / 3.0, 0.01);
  for (const Vec2f u : {Vec2f{0, 0}, Vec2f{0.99999994f, 0.99999994f}, Vec2f{0, 0.99999994f}}) {
    const EnvironmentSample s = environment_sample(map, u);
    EXPECT_TRUE(s.pdf > 0 && std::isfinite(s.pdf) && luminance(s.radiance) > 0);
  }
}

TEST(Environment, OneTexelIsAnEvenSphere) {
  const EnvironmentTable table = table_of(1, 1, {{2, 2, 2}});
  const EnvironmentView map = table.view(kUpright, 1);
  EXPECT_NEAR(map.illuminance, 8 * M_PI, 1e-3);
  EXPECT_NEAR(environment_pdf(map, {0.6f, 0, 0.8f}), 1 / (4 * M_PI), 2e-3 / (4 * M_PI) * 4);
  EXPECT_FLOAT_EQ(environment_radiance(map, {0.6f, 0, 0.8f}, 0.3f).x, 2);
  const Estimate e = estimate(map, true, 100000, [](Vec3f) { return 1.0; });
  EXPECT_NEAR(e.mean, 8 * M_PI, 1e-2);
  EXPECT_LT(std::sqrt(e.variance), 0.03 * e.mean);
}

TEST(Environment, BlackMapsGiveNoSample) {
  const EnvironmentTable table = table_of(8, 4, std::vector<Vec3f>(32, Vec3f{0, 0, 0}));
  const EnvironmentTable lit = table_of(8, 4, std::vector<Vec3f>(32, Vec3f{1, 1, 1}));
  for (const EnvironmentView& map :
       {table.view(kUpright, 1), lit.view(kUpright, 0), EnvironmentView{}}) {
    EXPECT_EQ(environment_pdf(map, {0, 0, 1}), 0);
    EXPECT_EQ(environment_sample(map, {0.3f, 0.6f}).pdf, 0);
    EXPECT_EQ(luminance(environment_radiance(map, {0, 0, 1}, 0.1f)), 0);
    EXPECT_EQ(map.illuminance, 0);
  }
}

TEST(Environment, CoarseLevelsKeepTheLight) {
  const std::vector<Vec3f> texels = patchy(150, 75);
  const EnvironmentTable table = table_of(150, 75, texels);
  const EnvironmentView map = table.view(kUpright, 1);
  std::vector<double> totals;
  for (uint32_t i = 0; i < map.levels.size; ++i) {
    const EnvironmentLevel& level = map.levels[i];
    double total = 0;
    for (int row = 0; row < level.height; ++row) {
      const double zone =
          std::cos(M_PI * row / level.height) - std::cos(M_PI * (row + 1) / level.height);
      for (int column = 0; column < level.width; ++column) {
        total += map.texels[level.first + static_cast<uint32_t>(row * level.width + column)].x *
                 zone / level.width;
      }
    }
    totals.push_back(total);
  }
  EXPECT_EQ(map.levels.size, 7u);
  for (const double total : totals) EXPECT_NEAR(total, totals[0], 1e-5 * totals[0]);
  // A wide footprint sees the mean, a narrow one the texel; in between it is continuous.
  const Vec3f d = direction(1, 2);
  EXPECT_NEAR(environment_radiance(map, d, 3).x, totals.back() / 2, 0.2 * totals.back());
  EXPECT_EQ(environment_radiance(map, d, 0.04f).x, environment_radiance(map, d, 0).x);
  for (float footprint = 0.03f; footprint < 1.5f; footprint *= 1.02f) {
    EXPECT_NEAR(environment_radiance(map, d, footprint).x,
                environment_radiance(map, d, footprint * 1.001f).x, 0.1);
  }
}

TEST(Environment, TexelsThatAreNoLightAreRefused) {
  const auto message = [](int width, int height, std::vector<Vec3f> texels) {
    const Result<EnvironmentTable> table = EnvironmentTable::make(width, height, texels, "x.exr");
    return table.ok() ? std::string() : table.error().to_string();
  };
  using testing::HasSubstr;
  std::vector<Vec3f> texels(8, Vec3f{1, 1, 1});
  EXPECT_EQ(message(4, 2, texels), "");
  texels[6].y = -1;
  EXPECT_THAT(message(4, 2, texels), HasSubstr("x.exr: texel in column 2, row 1"));
  texels[6].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message(4, 2, texels), HasSubstr("nan"));
  texels[6].y = std::numeric_limits<float>::infinity();
  EXPECT_THAT(message(4, 2, texels), HasSubstr("inf"));
  EXPECT_THAT(message(4, 3, texels), HasSubstr("8 texels for an environment map of 4 x 3"));
  EXPECT_THAT(message(0, 2, {}), HasSubstr("0 x 2"));
  EXPECT_THAT(message(-1, -8, texels), HasSubstr("-1 x -8"));
  EXPECT_THAT(message(1 << 20, 1 << 20, texels), HasSubstr("limit"));
}

}  // namespace
}  // namespace gloam
