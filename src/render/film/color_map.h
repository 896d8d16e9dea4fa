#pragma once
// Colours for numbers and for names, for people to look at.

#include <array>
#include <cstdint>

namespace gloam {

using Rgb8 = std::array<uint8_t, 3>;  ///< sRGB

/// Turbo, dark blue (0) over green to dark red (1): polynomial approximation published with
/// Mikhailov 2019, "Turbo, An Improved Rainbow Colormap for Visualization". x is clamped to 0..1.
Rgb8 turbo_color(float x);

/// Distinct colours of similar lightness for ids; 0 = nothing is dark grey. Hues step by the golden
/// angle in OKLCH (Ottosson 2020, "A perceptual color space for image processing").
Rgb8 label_color(uint32_t id);

}  // namespace gloam
