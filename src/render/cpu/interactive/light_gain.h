#pragma once
// Change of the light since the previous picture, by place in the picture. A mean over pictures
// lags behind light that changes evenly, unless the mean is scaled to the new level first.

#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "render/cpu/interactive/frame.h"

namespace gloam {

/// Places of the pixels from (x, y) on in the picture before.
struct InteractivePast {
  FloatLanes x, y;
  MaskLanes known = false;  ///< the same place was seen then
  bool rests = false;       ///< all were where they are

  FloatLanes of(const InteractivePlane& plane, int here_x, int here_y) const {
    return rests ? plane.load(here_x, here_y) : plane.gather_at(x, y);
  }
  Vec3Of<FloatLanes> of(const InteractivePlane3& plane, int here_x, int here_y) const {
    return rests ? plane.load(here_x, here_y) : plane.gather_at(x, y);
  }
};
InteractivePast find_past(const InteractiveFrame& before, const InteractiveFrame& f, int x, int y);

class LightGain;
/// One light in two pictures, and where to put how it has changed.
struct LightChange {
  const InteractivePlane3& before;
  const InteractivePlane3& now;
  LightGain* gain;
};
/// Measures the ratio of each pixel's luminance to the luminance of the same place in the previous
/// picture, for at most kSignals lights.
void measure_gains(const InteractiveFrame& before, const InteractiveFrame& now,
                   std::span<const LightChange> changes);

class LightGain {
 public:
  void resize(int width, int height);
  /// Light now over light before, about the pixels (x, y).
  FloatLanes at(FloatLanes x, float y) const;
  /// The same about the pixels from (x, y) on.
  FloatLanes from(int x, int y) const;

 private:
  friend void measure_gains(const InteractiveFrame& before, const InteractiveFrame& now,
                            std::span<const LightChange> changes);
  int columns_ = 0, rows_ = 0;
  bool changed_ = false;     ///< a gain is not 1
  std::vector<float> gain_;  ///< of patches, (rows x columns)
};

}  // namespace gloam
