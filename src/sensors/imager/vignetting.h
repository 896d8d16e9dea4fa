#pragma once
// Light falls off towards the corners of a picture.

#include "gloam/camera.h"
#include "gloam/scene_imager.h"

namespace gloam {

/// Factor on the light at the centre of pixel (x, y): cos⁴ of the angle between the pixel's ray and
/// the axis of a pinhole (Gardner 1947, "Validity of the cosine-fourth-power law of illumination")
/// times the even polynomial of the distance from the middle that flat-field calibrations fit
/// (Goldman 2010, "Vignette and Exposure Calibration and Compensation"). At least 0.
float vignetting(const VignettingOptions& options, const Intrinsics& intrinsics, int x, int y);

}  // namespace gloam
