#pragma once
// A picture of the fast tier before it is filtered, in planes of single floats with a border.

#include <vector>

#include "base/vec.h"
#include "render/kernel/lanes.h"

namespace gloam {

/// Rows of floats with kBorder more on all sides; a lane's load may start anywhere in it.
class FastPlane {
 public:
  static constexpr int kBorder = 16;
  void resize(int width, int height, float value) {
    stride_ = (width + kLaneCount - 1) / kLaneCount * kLaneCount + 2 * kBorder;
    values_.assign(static_cast<size_t>(stride_) * static_cast<size_t>(height + 2 * kBorder), value);
  }
  float* at(int x, int y) {
    return values_.data() + static_cast<ptrdiff_t>(y + kBorder) * stride_ + x + kBorder;
  }
  const float* at(int x, int y) const { return const_cast<FastPlane*>(this)->at(x, y); }

 private:
  std::vector<float> values_;
  int stride_ = 0;
};

struct FastPlane3 {
  FastPlane c[3];
  void resize(int width, int height, float value) {
    for (FastPlane& p : c) p.resize(width, height, value);
  }
  Vec3f get(int x, int y) const { return {*c[0].at(x, y), *c[1].at(x, y), *c[2].at(x, y)}; }
  void set(int x, int y, Vec3f v) {
    for (int k = 0; k < 3; ++k) *c[k].at(x, y) = v[k];
  }
};

/// The noisy parts: light of lamps, of the cache, of mirrors.
enum FastSignal { kDirectSignal, kCachedSignal, kSpecularSignal, kFastSignals };

struct FastFrame {
  int width = 0, height = 0;
  FastPlane3 signal[kFastSignals];
  /// Mean and mean square of the luminance of each signal over earlier pictures.
  FastPlane mean[kFastSignals], square[kFastSignals];
  FastPlane age;  ///< pictures that a pixel's signals are the mean of
  FastPlane3 p, n;
  FastPlane part;      ///< of the first solid surface; 0 = none, -1 = beyond the border
  FastPlane distance;  ///< [m]
  FastPlane roughness;
  FastPlane3 base, albedo, gloss, through;
  std::vector<Vec2f> motion;  ///< [px]
  std::vector<uint64_t> key;  ///< of the cache's cell

  void resize(int w, int h);
};

/// Room for the filter; the smoothed signals are in `a` at the end.
struct FastFilter {
  FastPlane3 a[kFastSignals], b[kFastSignals];

  void resize(int width, int height);
  /// Takes over from `before` what is the same place, as far as it agrees with what is new.
  void accumulate(const FastFrame& before, FastFrame* frame);
  /// Smooths the signals over surfaces.
  void smooth(const FastFrame& frame);
};

}  // namespace gloam
