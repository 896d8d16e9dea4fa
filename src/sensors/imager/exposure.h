#pragma once
// Exposure by f-number, shutter and speed, and the automatic that sets them.

#include "gloam/scene/imager.h"

namespace gloam {

/// Settings of an exposure.
struct Exposure {
  double f_number = 2.8;
  double shutter = 0.01;  ///< [s]
  double iso = 100;

  /// EV at ISO 100: log2(N² / t · 100 / S). The luminance at the top of the scale is 1.2 · 2^EV
  /// cd/m² (docs/light.md): ISO 12232's saturation-based speed 78 lx s / H with H = 0.65 L t / N².
  double ev100() const;
};

/// ISO 100 at f_number, with the shutter that gives `ev100`.
Exposure exposure_at(double ev100, double f_number);

/// The shutter opens for `ev100` up to max_shutter, then the speed rises up to max_iso; darker
/// pictures stay dark.
Exposure program_exposure(double ev100, double f_number, const AutoExposureOptions& options);

/// First-order approach, on simulation time, of the exposure value to what a meter says:
/// EV = log2(L · 100 / 12.5) for the mean luminance L, the calibration constant K = 12.5 of ISO
/// 2720:1974 (12.5 to 14 in cameras). The first reading is taken over at once.
class AutoExposure {
 public:
  explicit AutoExposure(const AutoExposureOptions& options) : options_(options) {}

  /// `luminance` [cd/m²] metered at `time` [s]; earlier than the last = the simulation began anew.
  void meter(double luminance, double time);
  double ev100() const { return ev100_; }
  const AutoExposureOptions& options() const { return options_; }
  void set_options(const AutoExposureOptions& options) { options_ = options; }

 private:
  AutoExposureOptions options_;
  bool started_ = false;
  double ev100_ = 0, time_ = 0;
};

/// Luminance at which an image saturates, over the metered one that exposes it.
double saturation_of(const AutoExposureOptions& options);

/// A small picture for metering. saturation: of saturation_of().
struct MeterImage {
  int width = 0, height = 0;
  bool center_weighted = false;  ///< by a Gaussian of a quarter of the width
  double saturation = 0;
};

/// Metered luminance [cd/m²] of radiance (height x width x 3), linear Rec. 709: the mean of an
/// image that this luminance itself exposes. Zones of 2 x 2 pixels above its scale count as
/// saturated, as in a camera that meters its own images, so a window in view does not darken the
/// room. The pixels themselves are too noisy: few samples of smoke are bright, and most are dark.
double metered_luminance(const float* radiance, const MeterImage& image);

}  // namespace gloam
