#include "render/cpu/interactive/light_gain.h"

#include <algorithm>

namespace gloam {
namespace {

using F = FloatLanes;

struct Sums {
  F n, past, change, square;  // by columns, so that they are the same for any number of lanes

  void add(MaskLanes known, F now, F before) {
    n += select(known, F(1.0f), F(0.0f));
    past += select(known, before, F(0.0f));
    const F difference = select(known, now - before, F(0.0f));
    change += difference;
    square += difference * difference;
  }
  static float sum(F columns, int first) {
    float total = 0;
    for (int i = first; i < first + interactive::kGainPatch; ++i) total += lane(columns, i);
    return total;
  }
  /// Gain of the patch whose columns are the lanes from `first` on.
  float gain(int first) const {
    const float count = sum(n, first), old = sum(past, first), more = sum(change, first);
    if (count < interactive::kLeastPixels || !(old > 0)) return 1;
    // Part of the change that is not likely to be chance (James and Stein 1961, the positive part).
    const float scatter = max(sum(square, first) - sqr(more) / count, 0.0f);
    const float variance = scatter * count / (count - 1);
    const float sure =
        max(1 - sqr(interactive::kGainSigma) * variance / max(sqr(more), 1e-30f), 0.0f);
    return clamp(1 + sure * more / old, 0.0f, interactive::kMostGain);
  }
};

}  // namespace

InteractivePast find_past(const InteractiveFrame& before, const InteractiveFrame& f, int x, int y) {
  F column;
  for (int i = 0; i < kLaneCount; ++i) set_lane(&column, i, static_cast<float>(x + i));
  const F motion_x = f.motion_x.load(x, y), motion_y = f.motion_y.load(x, y);
  const F from_x = floor_of(column + 0.5f - motion_x);
  const F from_y = floor_of(static_cast<float>(y) + 0.5f - motion_y);
  const MaskLanes inside = (from_x >= 0.0f) & (from_y >= 0.0f) &
                           (from_x < static_cast<float>(f.width)) &
                           (from_y < static_cast<float>(f.height));
  InteractivePast out;
  out.rests = all((motion_x == F(0.0f)) & (motion_y == F(0.0f)));
  out.x = select(inside, from_x, F(0.0f));
  out.y = select(inside, from_y, F(0.0f));
  const F part = f.part.load(x, y);
  const MaskLanes alike = (part == F(0.0f)) | (dot(f.n.load(x, y), out.of(before.n, x, y)) > 0.8f);
  out.known = inside & (part >= 0.0f) & (out.of(before.part, x, y) == part) & alike;
  return out;
}

void LightGain::resize(int width, int height) {
  columns_ = (width + interactive::kGainPatch - 1) / interactive::kGainPatch;
  rows_ = (height + interactive::kGainPatch - 1) / interactive::kGainPatch;
  changed_ = false;
  gain_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), 1.0f);
}

void measure_gains(const InteractiveFrame& before, const InteractiveFrame& now,
                   std::span<const LightChange> changes) {
  static_assert(kLaneCount % interactive::kGainPatch == 0);
  const int columns = changes[0].gain->columns_;
  parallel_for("interactive gain", changes[0].gain->rows_, [&](int64_t row) {
    const int y0 = static_cast<int>(row) * interactive::kGainPatch;
    for (int column = 0; column < columns; column += kLaneCount / interactive::kGainPatch) {
      const int x = column * interactive::kGainPatch;
      Sums sums[kSignals];
      for (int y = y0; y < std::min(y0 + interactive::kGainPatch, now.height); ++y) {
        const InteractivePast past = find_past(before, now, x, y);
        for (size_t i = 0; i < changes.size(); ++i) {
          sums[i].add(past.known, luminance(changes[i].now.load(x, y)),
                      luminance(past.of(changes[i].before, x, y)));
        }
      }
      for (size_t i = 0; i < changes.size(); ++i) {
        for (int k = 0; k < std::min(kLaneCount / interactive::kGainPatch, columns - column); ++k) {
          changes[i].gain->gain_[static_cast<size_t>(row * columns + column + k)] =
              sums[i].gain(k * interactive::kGainPatch);
        }
      }
    }
  });
  for (const LightChange& change : changes) {
    const std::vector<float>& gain = change.gain->gain_;
    change.gain->changed_ = std::any_of(gain.begin(), gain.end(), [](float g) { return g != 1; });
  }
}

FloatLanes LightGain::at(FloatLanes x, float y) const {
  if (!changed_) return 1.0f;
  constexpr float kScale = 1.0f / interactive::kGainPatch;
  const float right = static_cast<float>(columns_ - 1), low = static_cast<float>(rows_ - 1);
  const F fx = clamp((x + 0.5f) * kScale - 0.5f, F(0.0f), F(right));
  const float fy = clamp((y + 0.5f) * kScale - 0.5f, 0.0f, low);
  const int y0 = static_cast<int>(fy), y1 = std::min(y0 + 1, rows_ - 1);
  const F x0 = floor_of(fx), x1 = min(x0 + 1.0f, F(right));
  const auto row = [&](int patch_y) {
    const float* values = gain_.data() + static_cast<size_t>(patch_y) * columns_;
    return lerp(gather(values, to_uint(x0)), gather(values, to_uint(x1)), fx - x0);
  };
  return lerp(row(y0), row(y1), F(fy - static_cast<float>(y0)));
}

FloatLanes LightGain::from(int x, int y) const {
  if (!changed_) return 1.0f;
  F column;
  for (int i = 0; i < kLaneCount; ++i) set_lane(&column, i, static_cast<float>(x + i));
  return at(column, static_cast<float>(y));
}

}  // namespace gloam
