// When samples are taken and arrive, from 10^5 of them.
#include "sensors/timing.h"

#include "sensors/signal/draw.h"
#include "sensors/test/statistics.h"

namespace gloam {
namespace {

constexpr int64_t kSamples = 200000;

SensorTiming make(Rational rate, const TimingOptions& options, Rational timestep,
                  uint64_t seed = 7) {
  const auto timing = SensorTiming::make(rate, options, timestep, seed);
  if (!timing.ok()) {
    ADD_FAILURE() << timing.error().to_string();
    abort();
  }
  return *timing;
}

TEST(Draw, NormalNumbersAreNormal) {
  std::vector<double> x;
  for (uint32_t i = 0; i < kSamples; ++i) x.push_back(draw_normal({1, 2}, 3, i));
  expect_moments(x, 0, 1, "normal");
  double beyond = 0;
  for (const double v : x) beyond += std::abs(v) > 2 ? 1 : 0;
  const double p = std::erfc(std::sqrt(2.0));
  expect_within(beyond / kSamples, p, std::sqrt(p * (1 - p) / kSamples), "beyond two sigma");
}

TEST(Draw, PoissonsNumbersHaveTheirMeanVarianceAndSkew) {
  for (const double mean : {0.05, 1.0, 9.99, 10.01, 50.0, 900.0, 20000.0}) {
    std::vector<double> x;
    for (uint32_t i = 0; i < kSamples; ++i) x.push_back(draw_poisson({1, 2}, 3, i, mean));
    const std::string name = std::to_string(mean);
    expect_moments(x, mean, mean, name.c_str());
    double skew = 0;
    for (const double v : x) skew += std::pow((v - mean) / std::sqrt(mean), 3) / kSamples;
    // The variance of a third power: 15 for normal numbers, more for skewed ones.
    const double error = std::sqrt((15 + 25 / mean + 1 / (mean * mean) * 40) / kSamples);
    expect_within(skew, 1 / std::sqrt(mean), error, name.c_str());
  }
  EXPECT_EQ(draw_poisson({1, 2}, 3, 4, 0), 0);
}

TEST(Timing, WithoutOptionsSamplesAreThoseOfTheSchedule) {
  const Rational timestep{1, 500}, rate{30, 1};
  const SensorTiming timing = make(rate, {}, timestep);
  const StepSchedule schedule = *StepSchedule::make(rate, {0, 1}, timestep);
  for (int64_t k = 0; k < 1000; ++k) {
    EXPECT_EQ(timing.step_of(k), schedule.step_of(k));
    EXPECT_EQ(timing.delivery_of(k, 0.25), 0.25);
    EXPECT_FALSE(timing.dropped(k));
  }
}

// The step of sample k is that of phase + k / rate + jitter, rounded up: so the jitter is what is
// left after the mean rounding of half a step.
TEST(Timing, JitterHasItsSpreadAndNoDrift) {
  const double sigma = 0.001;
  for (const Rational timestep : {Rational{1, 100000}, Rational{1, 1100}}) {
    const double dt = timestep.value();
    const SensorTiming timing = make({30, 1}, {.phase = {1, 7}, .jitter = sigma}, timestep);
    std::vector<double> x;
    int64_t before = -1;
    for (int64_t k = 1; k <= kSamples; ++k) {
      const int64_t step = timing.step_of(k);
      EXPECT_GT(step, before);
      before = step;
      x.push_back((static_cast<double>(step) - 0.5) * dt - 1.0 / 7 - static_cast<double>(k) / 30);
    }
    expect_moments(x, 0, sigma * sigma + dt * dt / 12, "jitter");
    double product = 0;
    for (size_t i = 1; i < x.size(); ++i) product += x[i] * x[i - 1] / sigma / sigma;
    expect_within(product / kSamples, 0, 1.1 / std::sqrt(kSamples), "neighbours are independent");
  }
}

TEST(Timing, JitterOnCoarseStepsKeepsTheOrderAndFindsItsSamplesAgain) {
  const Rational timestep{1, 500};
  for (const Rational rate : {Rational{200, 1}, {60, 1}, {30000, 1001}}) {
    const double room = (1 / rate.value() - timestep.value()) / 8;
    const SensorTiming timing = make(rate, {.jitter = room}, timestep);
    for (int64_t k = 1; k < 5000; ++k) {
      const int64_t step = timing.step_of(k);
      EXPECT_GT(step, timing.step_of(k - 1));
      EXPECT_EQ(timing.first_at_or_after(step), k);
      EXPECT_EQ(timing.last_at_or_before(step), k);
      EXPECT_EQ(timing.first_at_or_after(timing.step_of(k - 1) + 1), k);
    }
  }
}

TEST(Timing, LatencyDropsAndTheirSeeds) {
  const TimingOptions options{.latency = 0.02, .latency_jitter = 0.003, .drop = 0.07};
  const SensorTiming timing = make({30, 1}, options, {1, 500}),
                     other = make({30, 1}, options, {1, 500}, 8);
  std::vector<double> latency;
  double lost = 0, same = 0, pairs = 0;
  for (int64_t k = 0; k < kSamples; ++k) {
    const double time = 0.01 * static_cast<double>(k % 100);
    latency.push_back(timing.delivery_of(k, time) - time);
    lost += timing.dropped(k) ? 1 : 0;
    same += timing.dropped(k) == other.dropped(k) ? 1 : 0;
    pairs += timing.dropped(k) && timing.dropped(k + 1) ? 1 : 0;
  }
  expect_moments(latency, 0.02, 9e-6, "latency");
  expect_within(lost / kSamples, 0.07, std::sqrt(0.07 * 0.93 / kSamples), "drops");
  const double p = 0.07 * 0.07 + 0.93 * 0.93;
  expect_within(same / kSamples, p, std::sqrt(p * (1 - p) / kSamples), "another seed");
  expect_within(pairs / kSamples, 0.0049, std::sqrt(0.0049 / kSamples), "one after the other");
}

TEST(Timing, WhatWouldChangeTheOrderIsAnError) {
  const auto message = [](Rational rate, const TimingOptions& options) {
    const auto timing = SensorTiming::make(rate, options, {1, 500}, 1);
    return timing.ok() ? std::string() : timing.error().to_string();
  };
  EXPECT_NE(message({30, 1}, {.jitter = 0.005}).find("at most"), std::string::npos);
  EXPECT_NE(message({30, 1}, {.latency_jitter = 0.005}).find("latency_jitter"), std::string::npos);
  EXPECT_NE(message({501, 1}, {}).find("501"), std::string::npos);
  EXPECT_NE(message({30, 1}, {.phase = {-1, 2}}).find("phase"), std::string::npos);
  EXPECT_NE(message({500, 1}, {.jitter = 1e-6}), "") << "no room between samples";
}

}  // namespace
}  // namespace gloam
