#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "render/film/denoise.h"
#include "render/kernel/film/light_gain.h"

namespace gloam {
namespace {

using WindowLight = Vec3Of<double>;

/// Sums over `n` values `stride` apart, each over those up to kWindowRadius away. Running sums in
/// double precision: lamps and the dark beside them are in one picture.
void sum_windows(WindowLight* values, int n, ptrdiff_t stride, std::vector<WindowLight>* scratch) {
  scratch->resize(static_cast<size_t>(n) + 1);
  WindowLight sum;
  for (int i = 0; i < n; ++i) {
    (*scratch)[static_cast<size_t>(i)] = sum;
    sum += values[i * stride];
  }
  (*scratch)[static_cast<size_t>(n)] = sum;
  for (int i = 0; i < n; ++i) {
    const auto first = static_cast<size_t>(std::max(0, i - kWindowRadius));
    const auto end = static_cast<size_t>(std::min(n, i + kWindowRadius + 1));
    values[i * stride] = (*scratch)[end] - (*scratch)[first];
  }
}

/// Sums over square windows, twice, which weighs pixels by a tent: no window has an edge that
/// shows.
std::vector<WindowLight> around(const std::vector<Vec3f>& picture, int width, int height) {
  std::vector<WindowLight> sums(picture.size());
  for (size_t i = 0; i < sums.size(); ++i) sums[i] = {picture[i].x, picture[i].y, picture[i].z};
  for (int pass = 0; pass < 2; ++pass) {
    parallel_for_range("restore_light", height, 16, [&](int64_t begin, int64_t end) {
      std::vector<WindowLight> scratch;
      for (int64_t y = begin; y < end; ++y) sum_windows(&sums[y * width], width, 1, &scratch);
    });
    parallel_for_range("restore_light", width, 16, [&](int64_t begin, int64_t end) {
      std::vector<WindowLight> scratch;
      for (int64_t x = begin; x < end; ++x) sum_windows(&sums[x], height, width, &scratch);
    });
  }
  return sums;
}

WindowLight total(const std::vector<Vec3f>& picture) {
  WindowLight sum;
  for (const Vec3f& p : picture) sum += {p.x, p.y, p.z};
  return sum;
}

}  // namespace

void restore_light(const std::vector<Vec3f>& light, int width, int height,
                   std::vector<Vec3f>* picture) {
  const std::vector<WindowLight> wanted = around(light, width, height);
  const std::vector<WindowLight> found = around(*picture, width, height);
  for (size_t i = 0; i < wanted.size(); ++i)
    (*picture)[i] *= light_gain(wanted[i], found[i], kMostWindowGain);
  const Vec3f rest = light_gain(total(light), total(*picture), kMostWholeGain);
  for (Vec3f& p : *picture) p *= rest;
}

}  // namespace gloam
