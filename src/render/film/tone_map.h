#pragma once
// Tone mapping, from light to display values.

#include <vector>

#include "render/kernel/film/tone.h"

namespace gloam {

/// Luminance that reaches full scale before the tone curve [cd/m²]: 1.2 * 2^EV100 (Lagarde & de
/// Rousiers 2014, "Moving Frostbite to PBR", saturation-based speed with q = 0.65).
float max_luminance(float ev100);

/// Radiance [cd/m²], (height x width), to 8-bit sRGB, (height x width x 3). The dither is a fixed
/// pattern over the picture, so equal radiance gives equal bytes in every run and frame. Values
/// that are not numbers become black.
void tone_map(const std::vector<Vec3f>& radiance, int width, int height,
              const ToneMapSettings& settings, std::vector<uint8_t>* rgb);

}  // namespace gloam
