#pragma once
// Normal and Poisson draws on top of base/rng.h: pure functions of (seed, stream, counter, index).

#include <utility>

#include "base/rng.h"

namespace gloam {

/// Two independent standard normal numbers (Box and Muller 1958).
std::pair<double, double> normal_pair(const Philox4& bits);

/// Standard normal number.
double draw_normal(const RandomStream& stream, uint64_t counter, uint32_t index);

/// Poisson's number of `mean` in 0 … 1e9, below 2^48 counters. Exact: inversion below 10, above it
/// the transformed rejection PTRS of Hörmann 1993, "The transformed rejection method for generating
/// Poisson random variables".
double draw_poisson(const RandomStream& stream, uint64_t counter, uint32_t index, double mean);

}  // namespace gloam
