#pragma once
// Light falls off towards the corners of a picture.

#include <vector>

#include "gloam/camera.h"
#include "gloam/scene/imager.h"

namespace gloam {

/// Factors on the light at the centres of pixels, (height x width), at least 0: cos⁴ of the angle
/// between the lens's ray and its axis, 0 behind it (Gardner 1947, "Validity of the cosine-fourth-
/// power law of illumination"), times the even polynomial of the distance from the middle that
/// flat-field calibrations fit (Goldman 2010, "Vignette and Exposure Calibration and
/// Compensation").
std::vector<float> vignetting(const VignettingOptions& options, const Intrinsics& intrinsics);

}  // namespace gloam
