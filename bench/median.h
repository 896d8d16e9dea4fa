#pragma once
// The middle of what was measured.

#include <algorithm>
#include <vector>

namespace gloam {

/// Of an even number the mean of the two in the middle; of nothing 0.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return n == 0 ? 0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace gloam
