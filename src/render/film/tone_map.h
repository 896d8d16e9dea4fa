#pragma once
// Tone mapping, from light to display values: exposure, tone curve, sRGB, dither.

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace gloam {

/// Luminance that reaches full scale before the tone curve [cd/m²]: 1.2 * 2^EV100 (Lagarde & de
/// Rousiers 2014, "Moving Frostbite to PBR", saturation-based speed with q = 0.65).
float max_luminance(float ev100);

/// Khronos PBR Neutral tone mapper 1.0 (https://github.com/KhronosGroup/ToneMapping): keeps base
/// colours of a scene lit to white, compresses and desaturates highlights only. Linear Rec. 709,
/// in >= 0, out 0..1.
Vec3f tone_curve_neutral(Vec3f color);

/// Tone curve after a sensor, whose channels fill up one by one, half the scale above its top: a
/// flame's orange turns to yellow where it is overexposed, as cameras show it, and not to the pink
/// that the curve alone makes of it. Light that fills all three channels is white, 1; light that
/// fills two is up to a hundredth more.
Vec3f tone_curve_of_sensor(Vec3f color);

struct ToneMapSettings {
  float ev100 = 0;
  bool neutral = true;  ///< false: no tone curve, what is above the top of the scale is cut
  bool dither = true;   ///< spreads the rounding error so that smooth gradients show no bands
};

/// Radiance [cd/m²], (height x width), to 8-bit sRGB, (height x width x 3). The dither is a fixed
/// pattern over the picture, so equal radiance gives equal bytes in every run and frame. Values
/// that are not numbers become black.
void tone_map(const std::vector<Vec3f>& radiance, int width, int height,
              const ToneMapSettings& settings, std::vector<uint8_t>* rgb);

}  // namespace gloam
