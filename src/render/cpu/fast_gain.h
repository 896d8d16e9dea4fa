#pragma once
// How much the light has changed since the picture before, by place in the picture. A mean over
// pictures lags behind light that changes evenly; brought up to the new level first, it does not.

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "render/cpu/fast_frame.h"

namespace gloam {

/// Where a pixel was in the picture before, if it is the same place.
bool find_before(const FastFrame& before, const FastFrame& f, int x, int y, int* bx, int* by);

class LightGain {
 public:
  static constexpr int kPatch = 8;  // [px], in which the change is sought

  void resize(int width, int height);
  /// light(x, y, &now, &past): luminance at a pixel, and before at the same place; false = unknown.
  template <class Light>
  void measure(const Light& light) {
    parallel_for("fast gain", static_cast<int64_t>(gain_.size()), [&](int64_t i) {
      const int x0 = static_cast<int>(i % columns_) * kPatch;
      const int y0 = static_cast<int>(i / columns_) * kPatch;
      Sums sums;
      for (int y = y0; y < min(y0 + kPatch, height_); ++y) {
        for (int x = x0; x < min(x0 + kPatch, width_); ++x) {
          float now, past;
          if (light(x, y, &now, &past)) sums.add(now, past);
        }
      }
      gain_[static_cast<size_t>(i)] = sums.gain();
    });
  }
  /// Light now over light before about a pixel.
  float at(int x, int y) const;
  FloatLanes from(int x, int y) const;  ///< at the pixels from (x, y) on

 private:
  struct Sums {
    float n = 0, past = 0, change = 0, square = 0;
    void add(float now, float before) {
      n += 1;
      past += before;
      change += now - before;
      square += sqr(now - before);
    }
    float gain() const;
  };

  int width_ = 0, height_ = 0, columns_ = 0, rows_ = 0;
  std::vector<float> gain_;  ///< of patches, (rows x columns)
};

}  // namespace gloam
