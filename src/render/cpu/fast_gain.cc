#include "render/cpu/fast_gain.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr float kLeast = 8;        // pixels that tell of a patch
constexpr float kSureness = 1.5f;  // standard errors that a change may be by chance
constexpr float kMostGain = 4;

}  // namespace

bool find_before(const FastFrame& before, const FastFrame& f, int x, int y, int* bx, int* by) {
  *bx = static_cast<int>(std::floor(static_cast<float>(x) + 0.5f - *f.motion_x.at(x, y)));
  *by = static_cast<int>(std::floor(static_cast<float>(y) + 0.5f - *f.motion_y.at(x, y)));
  if (*bx < 0 || *by < 0 || *bx >= f.width || *by >= f.height) return false;
  const float part = *f.part.at(x, y);
  return part > 0 && *before.part.at(*bx, *by) == part &&
         dot(f.n.get(x, y), before.n.get(*bx, *by)) > 0.8f;
}

void LightGain::resize(int width, int height) {
  width_ = width;
  height_ = height;
  columns_ = (width + kPatch - 1) / kPatch;
  rows_ = (height + kPatch - 1) / kPatch;
  gain_.assign(static_cast<size_t>(columns_) * rows_, 1.0f);
}

float LightGain::Sums::gain() const {
  if (n < kLeast || !(past > 0)) return 1;
  // Of the change, what is not likely to be chance (James and Stein 1961, the positive part).
  const float variance = max(square - sqr(change) / n, 0.0f) * n / (n - 1);
  const float sure = max(1 - sqr(kSureness) * variance / max(sqr(change), 1e-30f), 0.0f);
  return clamp(1 + sure * change / past, 0.0f, kMostGain);
}

float LightGain::at(int x, int y) const {
  const float fx =
      clamp((static_cast<float>(x) + 0.5f) / kPatch - 0.5f, 0.0f, static_cast<float>(columns_ - 1));
  const float fy =
      clamp((static_cast<float>(y) + 0.5f) / kPatch - 0.5f, 0.0f, static_cast<float>(rows_ - 1));
  const int x0 = static_cast<int>(fx), y0 = static_cast<int>(fy);
  const int x1 = std::min(x0 + 1, columns_ - 1), y1 = std::min(y0 + 1, rows_ - 1);
  const float* low = gain_.data() + static_cast<size_t>(y0) * columns_;
  const float* high = gain_.data() + static_cast<size_t>(y1) * columns_;
  const float u = fx - static_cast<float>(x0), v = fy - static_cast<float>(y0);
  const auto between = [](float a, float b, float t) { return a + (b - a) * t; };
  return between(between(low[x0], low[x1], u), between(high[x0], high[x1], u), v);
}

FloatLanes LightGain::from(int x, int y) const {
  FloatLanes out;
  for (int i = 0; i < kLaneCount; ++i) set_lane(&out, i, at(std::min(x + i, width_ - 1), y));
  return out;
}

}  // namespace gloam
