#pragma once
// Imager and timing of cameras: [camera.imager], [camera.timing]. Each model is off unless its
// table or value is given (docs/sensors.md).

#include <array>
#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [camera.timing], [sensor.timing]: times of samples and of their delivery. Sample k is taken at
/// the first physics step at or after phase + k / rate + its jitter, the aperture uncertainty of
/// IEEE Std 1241-2010. Losses are independent of each other (for simplicity; no source).
struct TimingOptions {
  Rational phase = {0, 1};  ///< time of sample 0 [s], >= 0
  double jitter =
      0;  ///< standard deviation of the time of a sample, truncated at four standard deviations [s]
  double latency = 0;  ///< time from the instant to its delivery [s]
  double latency_jitter =
      0;  ///< standard deviation of the latency, truncated at four standard deviations [s]
  double drop = 0;  ///< fraction of lost samples, independent of each other, 0 … 1
  SourceLoc loc = {};
};

/// [camera.imager.exposure]: by ISO 12232, as EV100 in docs/light.md.
struct ExposureOptions {
  double f_number = 2.8;  ///< focal length divided by the diameter of the aperture
  double shutter = 0.01;  ///< [s]
  double iso = 100;       ///< saturation-based speed
  SourceLoc loc = {};
};

/// [camera.imager.auto_exposure]: meters a separate image of 32 pixels' width at the camera's rate,
/// from the start of the simulation. The exposure of an image follows from the last metered image
/// before it. The reflected-light meter of ISO 2720.
struct AutoExposureOptions {
  double time_constant = 0.5;        ///< time constant for reaching the metered exposure value [s]
  double compensation = 0;           ///< brighter by this number of stops [EV]
  std::string metering = "average";  ///< average | center: a Gaussian of a quarter of the width
  double min_ev100 = -6, max_ev100 = 18;  ///< limits of the exposure value at ISO 100
  double max_shutter = 0.02;  ///< exposure time increases to this limit before the gain does [s]
  double max_iso = 1600;      ///< limit of the gain
  SourceLoc loc = {};
};

/// [camera.imager.vignetting]: factor on the light at a pixel (Gardner 1947, "Validity of the
/// cosine-fourth-power law of illumination"; polynomial: Goldman 2010).
struct VignettingOptions {
  bool cos4 = false;  ///< falloff by the angle between the pixel's ray and the axis of a pinhole
  /// 1 + a r² + b r⁴ + c r⁶, r = distance from the image centre divided by half the diagonal
  Vec3 polynomial = {0, 0, 0};
  SourceLoc loc = {};
};

/// [camera.imager.pixel]: from light to numbers, EMVA 1288 release 4.0 (linear model).
struct PixelOptions {
  double full_well = 10000;         ///< electrons at which a pixel is full
  double quantum_efficiency = 0.6;  ///< electrons per photon of 555 nm, 0 … 1
  double pitch = 3.5;               ///< pitch of the pixels [µm]
  bool shot_noise = false;          ///< Poisson noise of the number of electrons
  double read_noise = 0;            ///< standard deviation in the dark [electrons]
  double dark_current = 0;          ///< [electrons/s]; shot_noise applies to it as well
  double prnu = 0;                  ///< spread of the pixels' sensitivity, a fraction
  double dsnu = 0;                  ///< spread of the pixels' offsets [electrons]
  int bits = 0;                     ///< bits of the converter, 1 … 16; 0 = no quantisation
  int black_level = 0;              ///< value for no light [DN]
  SourceLoc loc = {};
};

/// [camera.imager]: includes a Bayer mosaic, demosaiced by Malvar, He and Cutler 2004, and baseline
/// JPEG (ITU-T T.81).
struct ImagerOptions {
  std::optional<ExposureOptions> exposure = {};
  std::optional<AutoExposureOptions> auto_exposure = {};  ///< takes its f-number from `exposure`
  std::optional<VignettingOptions> vignetting = {};
  std::optional<PixelOptions> pixel = {};
  std::string mosaic = "none";     ///< none rggb bggr grbg gbrg mono: colours of the top left 2 x 2
  Vec3 white_balance = {1, 1, 1};  ///< gains that make the sensor's red, green, blue neutral, >= 1
  std::string curve = "neutral";   ///< values above white: neutral rolls them off, srgb clips them
  int jpeg = 0;                    ///< quality of the compression, 1 … 100; 0 = none
  uint64_t seed = 0;               ///< beside the simulation's and the camera's name
  SourceLoc loc = {};
};

}  // namespace gloam
