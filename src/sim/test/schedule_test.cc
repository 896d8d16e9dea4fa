// Schedules in integers.

#include <gtest/gtest.h>

#include "sim/loop/step_schedule.h"

namespace gloam {
namespace {

TEST(ExactRational, FindsTheFractionThatWasMeant) {
  EXPECT_EQ(exact_rational(0.002), (Rational{1, 500}));
  EXPECT_EQ(exact_rational(0.005), (Rational{1, 200}));
  EXPECT_EQ(exact_rational(1.0 / 3), (Rational{1, 3}));
  EXPECT_EQ(exact_rational(1.0 / 240), (Rational{1, 240}));
  EXPECT_EQ(exact_rational(0.0125), (Rational{1, 80}));
  EXPECT_EQ(exact_rational(2.5), (Rational{5, 2}));
  EXPECT_EQ(exact_rational(10), (Rational{10, 1}));
  EXPECT_EQ(exact_rational(0), (Rational{0, 1}));
  EXPECT_EQ(exact_rational(-0.3), (Rational{-3, 10}));
  EXPECT_EQ(exact_rational(0.000123), (Rational{123, 1000000}));
}

TEST(ExactRational, IsTheSameNumberForEveryDecimalOfMicroseconds) {
  for (int64_t n = 1; n < 200000; n += 7) {
    const double x = static_cast<double>(n) / 1e6;
    const Rational r = exact_rational(x);
    ASSERT_EQ(r.value(), x);
    ASSERT_EQ(r.num * 1000000, n * r.den) << n;
  }
}

TEST(StepSchedule, MultiplesFallOnTheirExactSteps) {
  const StepSchedule s = *StepSchedule::make({50, 1}, {0, 1}, {1, 500});
  for (int64_t k = 0; k < 1000; ++k) EXPECT_EQ(s.step_of(k), 10 * k);
  EXPECT_EQ(s.first_at_or_after(0), 0);
  EXPECT_EQ(s.first_at_or_after(1), 1);
  EXPECT_EQ(s.first_at_or_after(10), 1);
  EXPECT_EQ(s.first_at_or_after(11), 2);
}

TEST(StepSchedule, OtherRatesAreLateByLessThanAStepAndNeverDrift) {
  const Rational rates[] = {{30, 1}, {30000, 1001}, {7, 3}, {499, 1}, {1, 1000}};
  const Rational phases[] = {{0, 1}, {1, 100}, {1, 3}};
  const Rational steps[] = {{1, 500}, {1, 240}, {1, 3}, {123, 1000000}};
  for (const Rational rate : rates) {
    for (const Rational phase : phases) {
      for (const Rational dt : steps) {
        if (rate.value() * dt.value() > 1) continue;
        const StepSchedule s = *StepSchedule::make(rate, phase, dt);
        for (int64_t k = 0; k < 100000; k = 3 * k + 1) {
          const long double t = static_cast<long double>(phase.num) / phase.den +
                                static_cast<long double>(k) * rate.den / rate.num;
          const long double at = static_cast<long double>(s.step_of(k)) * dt.num / dt.den;
          EXPECT_GE(at, t - 1e-12L);
          EXPECT_LT(at, t + static_cast<long double>(dt.num) / dt.den);
          EXPECT_EQ(s.first_at_or_after(s.step_of(k)), k);
          EXPECT_EQ(s.first_at_or_after(s.step_of(k) + 1), k + 1);
        }
      }
    }
  }
}

TEST(StepSchedule, RefusesRatesItCannotKeep) {
  EXPECT_FALSE(StepSchedule::make({0, 1}, {0, 1}, {1, 500}).ok());
  EXPECT_FALSE(StepSchedule::make({-5, 1}, {0, 1}, {1, 500}).ok());
  EXPECT_FALSE(StepSchedule::make({5, 0}, {0, 1}, {1, 500}).ok());
  EXPECT_FALSE(StepSchedule::make({5, 1}, {-1, 10}, {1, 500}).ok());
  EXPECT_FALSE(StepSchedule::make({501, 1}, {0, 1}, {1, 500}).ok());
  EXPECT_TRUE(StepSchedule::make({500, 1}, {0, 1}, {1, 500}).ok());
}

}  // namespace
}  // namespace gloam
