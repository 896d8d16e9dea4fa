#pragma once
// Filter of the fast tier's noisy pictures: over earlier pictures, over surfaces, over points of
// the pixels.

#include "render/cpu/realtime/fast_gain.h"

namespace gloam {

/// Filter over pictures and surfaces, and its scratch memory.
struct FastFilter {
  FastPlane3 a[kFastSignals], b[kFastSignals];
  FastPlane deviation[kFastSignals];         ///< of the signals' means, by the pixels around
  LightGain gain[kFastSignals], color_gain;  ///< of the signals, and of the whole light

  void resize(int width, int height);
  /// Blends in signals of the same places in `before`, as far as they agree with the new ones.
  void accumulate(const FastFrame& before, FastFrame* frame);
  /// Smooths the signals over surfaces, that of the air over what is as far away.
  void smooth(const FastFrame& frame);
  const FastPlane3& smoothed(FastSignal signal) const {
    return signal == kCachedSignal ? a[signal] : b[signal];
  }

 private:
  PlaneMemory memory_;
  /// One round for the signals of surfaces from kFirst on, over pixels 2^round apart.
  template <int kFirst>
  void smooth_signals(const FastFrame& f, int round, const FastPlane3* from, FastPlane3* to);
  void smooth_air(const FastFrame& f, int round, const FastPlane3& from, FastPlane3* to);
};

/// Means of frame->color and the pictures before: rays through other points of the pixels each time
/// make edges and textures smooth.
void resolve(const FastFrame& before, LightGain* gain, FastFrame* frame);

}  // namespace gloam
