#pragma once
// Tone mapping, from light to display values: exposure, tone curve, sRGB, dither.

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace gloam {

/// Luminance that reaches full scale before the tone curve [cd/m²]: 1.2 * 2^EV100 (Lagarde & de
/// Rousiers 2014, "Moving Frostbite to PBR", saturation-based speed with q = 0.65).
float max_luminance(float ev100);

/// Level up to which tone_curve() changes nothing; the default exposure puts white there.
inline constexpr float kShoulder = 0.85f;

/// Tone curve of one channel, in >= 0, out 0 … 1: what is no brighter than kShoulder is shown as it
/// is; above, the rest of the scale is approached exponentially, with the same slope at first, so
/// that 1 becomes 0.945 and three times white 1. Channels fill up one by one, as pixels of a sensor
/// do: a flame's orange turns to yellow where it is overexposed.
float tone_curve(float x);

struct ToneMapSettings {
  float ev100 = 0;
  bool neutral = true;  ///< false: no tone curve, what is above the top of the scale is clipped
  bool dither = true;   ///< spreads the rounding error so that smooth gradients show no bands
};

/// Radiance [cd/m²], (height x width), to 8-bit sRGB, (height x width x 3). The dither is a fixed
/// pattern over the picture, so equal radiance gives equal bytes in every run and frame. Values
/// that are not numbers become black.
void tone_map(const std::vector<Vec3f>& radiance, int width, int height,
              const ToneMapSettings& settings, std::vector<uint8_t>* rgb);

}  // namespace gloam
