#pragma once
// Measures of the detail in a picture and in a scan.

#include <vector>

#include "gloam/sensor.h"

namespace gloam {

/// Root mean square of how the logarithm of luminance differs between pixels four apart, along rows
/// and columns: what features are found by. What is darker than a hundredth of the mean counts
/// little. `radiance`: linear Rec. 709, (height x width x 3).
double contrast_of(const std::vector<float>& radiance, int width);

/// First returns of a scan with truth, as fractions of its beams.
struct ReturnShares {
  double surfaces = 0, media = 0;
};
ReturnShares returns_of(const LidarScan& scan);

}  // namespace gloam
