#pragma once
// From light to display values, one pixel: exposure, tone curve, sRGB, dither. Device-safe.

#include "base/srgb.h"
#include "base/vec.h"

namespace gloam {

struct ToneMapSettings {
  float ev100 = 0;
  bool neutral = true;  ///< false: no tone curve, what is above the top of the scale is clipped
  bool dither = true;   ///< spreads the rounding error so that smooth gradients show no bands
};

/// Level up to which tone_curve() changes nothing; the default exposure puts white there.
inline constexpr float kShoulder = 0.85f;

/// Tone curve of one channel, in >= 0, out 0 … 1: what is no brighter than kShoulder is shown as it
/// is; above, the rest of the scale is approached exponentially, with the same slope at first, so
/// that 1 becomes 0.945 and three times white 1. Channels fill up one by one, as pixels of a sensor
/// do: a flame's orange turns to yellow where it is overexposed.
GLOAM_HD float tone_curve(float x) {
  constexpr float kHeadroom = 1 - kShoulder;
  return x <= kShoulder ? x : 1 - kHeadroom * expf((kShoulder - x) / kHeadroom);
}

/// Interleaved gradient noise, 0 … 1 (Jimenez 2014, "Next Generation Post Processing in Call of
/// Duty"): even in every neighbourhood, so it dithers nearly as well as blue noise without a table.
GLOAM_HD float gradient_noise(int x, int y) {
  const float inner = 0.06711056f * static_cast<float>(x) + 0.00583715f * static_cast<float>(y);
  const float outer = 52.9829189f * (inner - floorf(inner));
  return outer - floorf(outer);
}

/// Display value of one channel, 0 … 255. `relative`: light over max_luminance(); values that are
/// not numbers become black. `threshold`: 0 … 1, of the rounding.
GLOAM_HD uint8_t display_value(float relative, bool neutral, float threshold) {
  float level = relative > 0 ? min(relative, 1e6f) : 0.0f;  // also for NaN
  if (neutral) level = tone_curve(level);
  return static_cast<uint8_t>(min(255 * srgb_encode(clamp(level, 0, 1)) + threshold, 255.0f));
}

/// Writes the three display values of the pixel (x, y).
GLOAM_HD void tone_map_pixel(Vec3f relative, int x, int y, const ToneMapSettings& settings,
                             uint8_t* rgb) {
  const float threshold = settings.dither ? gradient_noise(x, y) : 0.5f;
  for (int c = 0; c < 3; ++c) rgb[c] = display_value(relative[c], settings.neutral, threshold);
}

}  // namespace gloam
