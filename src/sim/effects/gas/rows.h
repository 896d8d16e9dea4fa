#pragma once
// Loops over the rows of a grid, on several threads, and sums that do not depend on how many.

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

inline constexpr int kLongestRow = 1024;  ///< cells along an axis

using Field = std::vector<float>;

/// Calls f(j, k) for each row of x.
template <class F>
void for_rows(const Shape& s, F&& f) {
  // Small levels of the multigrid are not worth a second thread.
  const int64_t grain = std::max(1, 8192 / s.nx);
  parallel_for_range("gas", int64_t(s.ny) * s.nz, grain, [&s, &f](int64_t begin, int64_t end) {
    for (int64_t r = begin; r < end; ++r) f(int(r % s.ny), int(r / s.ny));
  });
}

/// Calls f(i) for i of [0, n), each of which is much work.
template <class F>
void for_slabs(int n, F&& f) {
  parallel_for_range("gas", n, 2, [&f](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) f(int(i));
  });
}

/// Sum of f(c) over a row of n cells from c = `begin`: sixteen sums side by side, in one order on
/// every machine.
template <class F>
double row_sum(int begin, int n, F&& f) {
  float lanes[16] = {};
  int i = 0;
  for (; i + 16 <= n; i += 16) {
    GLOAM_IVDEP
    for (int l = 0; l < 16; ++l) lanes[l] += f(begin + i + l);
  }
  for (int l = 0; i < n; ++i, ++l) lanes[l] += f(begin + i);
  double sum = 0;
  for (const float lane : lanes) sum += double(lane);
  return sum;
}

/// Sum over the grid of what f(j, k) gives for each row (double). `partial`: scratch for nz.
template <class F>
double grid_sum(const Shape& s, std::vector<double>& partial, F&& f) {
  for_slabs(s.nz, [&s, &f, &partial](int k) {
    double sum = 0;
    for (int j = 0; j < s.ny; ++j) sum += f(j, k);
    partial[size_t(k)] = sum;
  });
  double sum = 0;
  for (int k = 0; k < s.nz; ++k) sum += partial[size_t(k)];
  return sum;
}

}  // namespace gloam::gas
