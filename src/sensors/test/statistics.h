#pragma once
// Moments of samples and their standard errors, to compare models with their parameters.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gloam {

struct Moments {
  double mean = 0, variance = 0;
  double mean_error = 0;      ///< standard error of the mean
  double variance_error = 0;  ///< of the variance, from the fourth moment
  double deviation() const { return std::sqrt(variance); }
  double deviation_error() const { return variance_error / (2 * deviation()); }
};

template <class T>
Moments moments(const std::vector<T>& samples) {
  const auto n = static_cast<double>(samples.size());
  Moments out;
  for (const T x : samples) out.mean += double{x} / n;
  double fourth = 0;
  for (const T x : samples) {
    const double d2 = (double{x} - out.mean) * (double{x} - out.mean);
    out.variance += d2 / (n - 1);
    fourth += d2 * d2 / n;
  }
  out.mean_error = std::sqrt(out.variance / n);
  out.variance_error = std::sqrt(std::max(0.0, fourth - out.variance * out.variance) / n);
  return out;
}

/// Within three standard errors.
inline void expect_within(double measured, double expected, double error, const char* what) {
  EXPECT_GT(error, 0) << what;
  EXPECT_NEAR(measured, expected, 3 * error) << what;
}

template <class T>
void expect_moments(const std::vector<T>& samples, double mean, double variance, const char* what) {
  const Moments m = moments(samples);
  expect_within(m.mean, mean, m.mean_error, what);
  expect_within(m.variance, variance, m.variance_error, what);
}

}  // namespace gloam
