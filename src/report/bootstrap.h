#pragma once
// Intervals of means over few runs, without a model of how they are distributed.

#include <span>
#include <string>

namespace gloam {

struct MeanInterval {
  double mean = 0;
  double low = 0, high = 0;  ///< 95 %; the mean itself of fewer than two values
  size_t count = 0;
};

inline constexpr int kBootstrapDraws = 10'000;

/// Percentile bootstrap of the mean (Efron and Tibshirani 1993, chapter 13): values are drawn with
/// replacement 10,000 times, the interval is from the 2.5th to the 97.5th percentile of the means.
/// Draws are keyed by `name`: the same numbers give the same interval. `values`: finite, at least
/// one.
MeanInterval bootstrap_mean(std::span<const double> values, const std::string& name);

}  // namespace gloam
