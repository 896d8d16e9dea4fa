#include "base/wave_math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gloam {
namespace {

TEST(WaveMath, SinesAndCosinesAreThoseOfTheLibrary) {
  for (int i = -200000; i <= 200000; ++i) {
    const double x = 0.01 * i + 1e-4 * (i % 7);
    const SinCos is = sin_cos(x);
    ASSERT_NEAR(is.sin, std::sin(x), 1e-12) << x;
    ASSERT_NEAR(is.cos, std::cos(x), 1e-12) << x;
  }
  for (int i = 1; i < 1000; ++i) {
    const double x = 999.7 * i;
    ASSERT_NEAR(sin_cos(x).sin, std::sin(x), 1e-9) << x;
    ASSERT_NEAR(sin_cos(-x).cos, std::cos(x), 1e-9) << x;
  }
  EXPECT_EQ(sin_cos(0).sin, 0);
  EXPECT_EQ(sin_cos(0).cos, 1);
}

TEST(WaveMath, ExponentialsAreThoseOfTheLibrary) {
  for (int i = -70000; i <= 70000; ++i) {
    const double x = 0.01 * i, exact = std::exp(x);
    ASSERT_NEAR(exponential(x), exact, 1e-13 * exact) << x;
  }
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(exponential(-1e9), exponential(-700));
  EXPECT_EQ(exponential(1e9), exponential(700));
}

TEST(WaveMath, LogarithmsAndPowersAreThoseOfTheLibrary) {
  for (int i = -69000; i <= 69000; ++i) {
    const double x = std::exp(0.01 * i), exact = std::log(x);
    ASSERT_NEAR(logarithm(x), exact, 1e-14 * std::max(std::abs(exact), 1.0)) << x;
  }
  for (int i = -4000; i <= 4000; ++i) {
    const double x = 1 + 1e-4 * i;
    ASSERT_NEAR(logarithm(x), std::log(x), 2e-15) << x;
    for (const double n : {0.2, 0.5, 1.0, 1.1, 1.6})
      ASSERT_NEAR(power(x, n), std::pow(x, n), 1e-13) << x << "^" << n;
  }
  EXPECT_EQ(logarithm(1), 0);
  EXPECT_EQ(power(1, 1.1), 1);
}

}  // namespace
}  // namespace gloam
