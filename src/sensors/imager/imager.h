#pragma once
// A camera's imager: linear light in, the sensor's raw numbers and the picture out. In this order:
// vignetting, colour filters, pixels, demosaicing, white balance, tone curve, JPEG.

#include <memory>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "gloam/camera.h"
#include "gloam/scene/imager.h"
#include "sensors/imager/exposure.h"
#include "sensors/imager/mosaic.h"
#include "sensors/imager/pixel.h"

namespace gloam {

class Imager {
 public:
  /// `seed`: sensor_seed() of the camera. The intrinsics are those of the pictures.
  Imager(const ImagerOptions& options, const Intrinsics& intrinsics, uint64_t seed);

  /// A picture from radiance [cd/m²], (height x width). A function of (seed, frame, radiance,
  /// exposure) alone. `rgb` as CameraFrame::rgb; `raw` as CameraFrame::raw, null if not wanted.
  void develop(const std::vector<Vec3f>& radiance, const Exposure& exposure, int64_t frame,
               std::vector<uint8_t>* rgb, std::vector<uint16_t>* raw);

  /// Memory that it takes [bytes].
  static uint64_t memory(const ImagerOptions& options, const Intrinsics& intrinsics);

 private:
  size_t sites_per_pixel() const { return mosaic_ || mono_ ? 1 : 3; }
  void expose(const std::vector<Vec3f>& radiance, const Exposure& exposure, int64_t frame,
              std::vector<uint16_t>* raw);
  void join_colors(float top_light, float full);

  const ImagerOptions options_;
  const Intrinsics intrinsics_;
  const bool mono_;
  std::optional<Mosaic> mosaic_;
  std::optional<PixelArray> pixels_;
  std::vector<float> vignetting_;  // factors on the light of pixels; empty = none
  std::vector<float> shares_;      // fractions of the top of the scale, per site
  std::vector<Vec3f> light_;       // the developed picture's [cd/m²]
};

}  // namespace gloam
