#pragma once
// Measurements in 16-bit PNG files.

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/image/png_writer.h"

namespace gloam {

/// Depth as ROS and most data sets store it: metres to whole millimetres, rounded to nearest.
/// 0 = nothing hit, or outside of what 16 bits hold (below 0.5 mm, from 65.5355 m).
std::vector<uint16_t> depth_to_millimetres(std::span<const float> depth);

/// Temperatures [K] as most thermal cameras put them out: hundredths of a kelvin, 0 … 655.35 K.
std::vector<uint16_t> to_centikelvins(std::span<const float> temperature);

}  // namespace gloam
