// Errors of signals against their parameters, by Allan's figures.
#include "sensors/signal/signal_model.h"

#include <numbers>

#include "scene/options/pattern_names.h"
#include "sensors/test/statistics.h"

namespace gloam {
namespace {

constexpr double kRate = 100;  // [Hz]

/// What a sensor at rest says, of each of its components.
std::vector<std::vector<double>> record(const SignalErrors& errors, int64_t samples,
                                        int components = 1, uint64_t seed = 3) {
  SignalModel model(errors, SensorKind::kNumbers, components, kRate, seed);
  std::vector<std::vector<double>> out(static_cast<size_t>(components));
  std::vector<double> values;
  for (int64_t k = 0; k < samples; ++k) {
    values.assign(static_cast<size_t>(components), 0);
    model.apply(k, values);
    for (size_t i = 0; i < values.size(); ++i) out[i].push_back(values[i]);
  }
  return out;
}

struct Allan {
  double variance = 0, error = 0;
};

/// Half the mean square of the differences between neighbouring averages over `tau`.
Allan allan(const std::vector<std::vector<double>>& records, double tau) {
  const auto n = static_cast<size_t>(std::llround(tau * kRate));
  std::vector<double> halves;
  for (const std::vector<double>& x : records) {
    double before = 0;
    for (size_t i = 0; i + n <= x.size(); i += n) {
      double mean = 0;
      for (size_t j = i; j < i + n; ++j) mean += x[j] / static_cast<double>(n);
      // Every second difference, so that they share no average.
      if (i % (2 * n) != 0) halves.push_back(0.5 * (mean - before) * (mean - before));
      before = mean;
    }
  }
  const Moments m = moments(halves);
  return {m.mean, m.mean_error};
}

TEST(Signal, WhiteNoiseHasTheDensityOfItsDataSheet) {
  const SignalErrors errors{.noise_density = 0.008};
  const auto x = record(errors, 400000);
  expect_moments(x[0], 0, 0.008 * 0.008 * kRate / 2, "in half the rate's bandwidth");
  const Allan second = allan(x, 1), tenth = allan(x, 0.1);
  expect_within(second.variance, 0.008 * 0.008 / 2, second.error, "Allan variance at 1 s");
  const double slope = 0.5 * std::log10(second.variance / tenth.variance);
  expect_within(slope, -0.5,
                0.5 / std::numbers::ln10 *
                    std::hypot(second.error / second.variance, tenth.error / tenth.variance),
                "slope of the deviation");
  const auto plain = record({.noise = 0.25}, 200000);
  expect_moments(plain[0], 0, 0.0625, "noise per sample");
}

TEST(Signal, ARandomWalkHasItsSlope) {
  const SignalErrors errors{.random_walk = 0.01};
  const auto x = record(errors, 400000, 4);
  for (const double tau : {1.0, 10.0}) {
    const Allan a = allan(x, tau);
    expect_within(a.variance, 1e-4 * tau / 3, a.error, "Allan variance");
  }
}

TEST(Signal, BiasInstabilityIsFlatWhereItShouldBe) {
  const SignalErrors errors{.bias_instability = 0.003};
  const SignalModel model(errors, SensorKind::kNumbers, 1, kRate, 1);
  for (double tau = 1; tau <= 1000; tau *= 1.7)
    EXPECT_NEAR(std::sqrt(model.allan_variance(tau)), 0.003, 0.03 * 0.003) << tau;
  const auto x = record(errors, 300000, 6);
  for (const double tau : {1.0, 8.0, 60.0}) {
    const Allan a = allan(x, tau);
    expect_within(a.variance, model.allan_variance(tau), a.error, "Allan variance");
  }
}

TEST(Signal, PartsHaveTheFiguresOfTheirDataSheets) {
  // The ADIS16470's sheet gives an angular random walk of 0.34 °/√h beside its density, which is
  // the Allan deviation at 1 s.
  SensorOptions options;
  options.preset = "adis16470_gyro";
  const SignalModel model(signal_errors(options), SensorKind::kNumbers, 3, kRate, 1);
  SignalErrors white = signal_errors(options);
  white.bias_instability = 0;
  const double at_1s =
      std::sqrt(SignalModel(white, SensorKind::kNumbers, 3, kRate, 1).allan_variance(1));
  EXPECT_NEAR(at_1s * 180 / std::numbers::pi * 60, 0.34, 0.005);
  const double at_600s = std::sqrt(model.allan_variance(1000)) * 180 / std::numbers::pi * 3600;
  EXPECT_NEAR(at_600s, 8, 0.4);
  options.noise_density = 0.5;
  EXPECT_EQ(signal_errors(options).noise_density, 0.5) << "the table wins";
  for (const std::string_view name : kSignalPresets) {
    options = {};
    options.preset = std::string(name);
    const SignalErrors e = signal_errors(options);
    EXPECT_EQ(e.noise_density + e.noise > 0, name != "none") << name;
  }
}

TEST(Signal, ConstantErrorsAreDrawnOncePerSensor) {
  std::vector<double> bias, scale;
  for (uint64_t seed = 0; seed < 20000; ++seed) {
    SignalModel model({.bias = 0.2, .offset = 1, .scale_error = 0.01}, SensorKind::kNumbers, 3,
                      kRate, seed);
    double a[3] = {0, 0, 0}, b[3] = {10, 10, 10}, again[3] = {0, 0, 0};
    model.apply(0, a);
    model.apply(1, b);
    model.apply(500, again);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(a[i], again[i]);
      bias.push_back(a[i]);
      scale.push_back((b[i] - a[i]) / 10);
    }
  }
  expect_moments(bias, 1, 0.04, "bias");
  expect_moments(scale, 1, 1e-4, "scale");
}

TEST(Signal, SaturatesAndQuantises) {
  SignalModel model({.range = 2, .resolution = 0.25}, SensorKind::kNumbers, 4, kRate, 1);
  double values[4] = {0.3, -0.9, 5, -1e300};
  model.apply(0, values);
  EXPECT_EQ(values[0], 0.25);
  EXPECT_EQ(values[1], -1);
  EXPECT_EQ(values[2], 2);
  EXPECT_EQ(values[3], -2);
}

TEST(Signal, RotationsDirectionsAndDistancesStayWhatTheyAre) {
  std::vector<double> angle;
  SignalModel turned({.noise = 0.01}, SensorKind::kRotation, 4, kRate, 1);
  for (int64_t k = 0; k < 40000; ++k) {
    double q[4] = {0.5, -0.5, 0.5, 0.5};
    turned.apply(k, q);
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-12);
    // X part of conj(q0) q, twice: the small rotation about the sensor's own X.
    angle.push_back(2 * (0.5 * q[1] + 0.5 * q[0] - (0.5 * q[3] - 0.5 * q[2])));
  }
  expect_moments(angle, 0, 1e-4, "rotation about X");
  SignalModel aimed({.noise = 0.05}, SensorKind::kDirection, 3, kRate, 1);
  double n[3] = {0, 0, 1};
  aimed.apply(0, n);
  EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-12);
  EXPECT_NE(n[0], 0);
  SignalModel beam({.noise = 0.5, .offset = 1}, SensorKind::kDistance, 2, kRate, 1);
  double d[2] = {-1, 0};
  beam.apply(0, d);
  EXPECT_EQ(d[0], -1) << "nothing there";
  EXPECT_GE(d[1], 0);
}

TEST(Signal, DriftGoesOnWhileNobodyLooks) {
  const SignalErrors errors{.noise_density = 0.1, .bias_instability = 0.2, .random_walk = 0.3};
  const auto all = record(errors, 1000);
  SignalModel late(errors, SensorKind::kNumbers, 1, kRate, 3);
  for (const int64_t k : {int64_t{700}, int64_t{999}, int64_t{20}}) {
    double value[1] = {0};
    late.apply(k, value);
    EXPECT_EQ(value[0], all[0][static_cast<size_t>(k)]) << k;
  }
  EXPECT_NE(record(errors, 10, 1, 4)[0], record(errors, 10, 1, 3)[0]) << "another seed";
}

TEST(Signal, WithoutErrorsTheNumbersAreTheTruth) {
  SignalModel model({}, SensorKind::kNumbers, 3, kRate, 1);
  double values[3] = {1.0 / 3, -1e-300, 1e300};
  model.apply(17, values);
  EXPECT_EQ(values[0], 1.0 / 3);
  EXPECT_EQ(values[1], -1e-300);
  EXPECT_EQ(values[2], 1e300);
}

}  // namespace
}  // namespace gloam
