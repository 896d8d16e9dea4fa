#pragma once
// Luminance and colour of glowing things.

#include "base/vec.h"

namespace gloam {

/// Luminance of a black body at `temperature` [K] per channel of linear Rec. 709 [cd/m²]: Planck's
/// law with the constants of the SI of 2019, over color_matching() (world/materials/spectrum.h).
/// Colour outside of the gamut (blue below some 1900 K) is clipped, so that embers do not turn
/// grey; luminance is kept.
Vec3f black_body_luminance(double temperature);

}  // namespace gloam
