#pragma once
// Change of the light since the picture before, by place in the picture. A mean over pictures lags
// behind light that changes evenly; brought up to the new level first, it does not.

#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "render/cpu/realtime/fast_frame.h"

namespace gloam {

/// Places of the pixels from (x, y) on in the picture before.
struct FastPast {
  FloatLanes x, y;
  MaskLanes known = false;  ///< the same place was seen then
  bool rests = false;       ///< all were where they are

  FloatLanes of(const FastPlane& plane, int here_x, int here_y) const {
    return rests ? plane.load(here_x, here_y) : plane.gather_at(x, y);
  }
  Vec3Of<FloatLanes> of(const FastPlane3& plane, int here_x, int here_y) const {
    return rests ? plane.load(here_x, here_y) : plane.gather_at(x, y);
  }
};
FastPast find_past(const FastFrame& before, const FastFrame& f, int x, int y);

class LightGain;
/// One light in two pictures, and where to put how it has changed.
struct LightChange {
  const FastPlane3& before;
  const FastPlane3& now;
  LightGain* gain;
};
/// Compares luminances of the pixels with those of the same places before; of kFastSignals lights
/// at most.
void measure_gains(const FastFrame& before, const FastFrame& now,
                   std::span<const LightChange> changes);

class LightGain {
 public:
  void resize(int width, int height);
  /// Light now over light before, about the pixels from (x, y) on.
  FloatLanes from(int x, int y) const;

 private:
  friend void measure_gains(const FastFrame& before, const FastFrame& now,
                            std::span<const LightChange> changes);
  int columns_ = 0, rows_ = 0;
  bool changed_ = false;     ///< a gain is not 1
  std::vector<float> gain_;  ///< of patches, (rows x columns)
};

}  // namespace gloam
