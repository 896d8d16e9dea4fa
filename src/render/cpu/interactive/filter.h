#pragma once
// Filter of the interactive tier's noisy pictures: over earlier pictures, over surfaces, over
// points of the pixels.

#include "render/cpu/interactive/light_gain.h"

namespace gloam {

/// Filter over pictures and surfaces, and its scratch memory.
struct InteractiveFilter {
  InteractivePlane3 a[kSignals], b[kSignals];
  InteractivePlane deviation[kSignals];  ///< of the signals' means, by the pixels around
  LightGain gain[kSignals], color_gain;  ///< of the signals, and of the whole light

  void resize(int width, int height);
  /// Blends in signals of the same places in `before`, as far as they agree with the new ones.
  void accumulate(const InteractiveFrame& before, InteractiveFrame* frame);
  /// Smooths the signals of surfaces over each surface, and the signal of the air over pixels of
  /// similar distance.
  void smooth(const InteractiveFrame& frame);
  const InteractivePlane3& smoothed(InteractiveSignal signal) const {
    return signal == kCachedSignal ? a[signal] : b[signal];
  }

 private:
  PlaneMemory memory_;
  /// One round for the signals of surfaces from kFirst on, over pixels 2^round apart.
  template <int kFirst>
  void smooth_signals(const InteractiveFrame& f, int round, const InteractivePlane3* from,
                      InteractivePlane3* to);
  void smooth_air(const InteractiveFrame& f, int round, const InteractivePlane3& from,
                  InteractivePlane3* to);
};

/// Adds frame.color to the means of `past`: rays through other points of the pixels each time make
/// edges and textures smooth, and add up to the resolution of `out`.
void resolve(const InteractiveFrame& before, const InteractiveFrame& frame, LightGain* gain,
             const ResolvedImage& past, ResolvedImage* out);

}  // namespace gloam
