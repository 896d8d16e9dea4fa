#include "report/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "base/rng.h"

namespace gloam {
namespace {

// Percentile between the two nearest ranks, as numpy's default.
double percentile(const std::vector<double>& sorted, double fraction) {
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

MeanInterval bootstrap_mean(std::span<const double> values, const std::string& name) {
  GLOAM_CHECK(!values.empty(), "the mean of no values");
  const auto n = static_cast<double>(values.size());
  MeanInterval out;
  out.count = values.size();
  for (const double v : values) out.mean += v / n;
  out.low = out.high = out.mean;
  if (values.size() < 2) return out;
  const RandomStream random{0, stream_id(("report.bootstrap." + name).c_str())};
  std::vector<double> means(kBootstrapDraws);
  for (size_t draw = 0; draw < means.size(); ++draw) {
    double sum = 0;
    for (size_t k = 0; k < values.size(); ++k) {
      const double u = random.uniform(draw, static_cast<uint32_t>(k));
      sum += values[static_cast<size_t>(u * n)] / n;
    }
    means[draw] = sum;
  }
  std::sort(means.begin(), means.end());
  out.low = percentile(means, 0.025);
  out.high = percentile(means, 0.975);
  return out;
}

}  // namespace gloam
