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

/// Metered luminance of a small picture [cd/m²]: radiance (height x width x 3), linear Rec. 709.
double metered_luminance(const float* radiance, int width, int height, bool center_weighted);

}  // namespace gloam
