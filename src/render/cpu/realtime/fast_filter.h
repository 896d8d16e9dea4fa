#pragma once
// From noisy pictures of the fast tier to smooth ones: over pictures, over surfaces, over points of
// the pixels.

#include "render/cpu/realtime/fast_gain.h"

namespace gloam {

/// Room for the filter.
struct FastFilter {
  FastPlane3 a[kFastSignals], b[kFastSignals];
  FastPlane deviation[kFastSignals];         ///< of the signals' means, by the pixels around
  LightGain gain[kFastSignals], color_gain;  ///< of the signals, and of the whole light

  void resize(int width, int height);
  /// Takes over from `before` what is the same place, as far as it agrees with what is new.
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
