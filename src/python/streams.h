#pragma once
// Requests of pictures out of Python's keyword arguments.

#include "core.h"
#include "gloam/camera_stream.h"

namespace gloam::python {

/// Options that are not given are the scene's. A tier other than "path", or a number of samples,
/// without an error bound leaves out the bound of the scene, which they contradict.
RenderOptions render_options(Keywords& keywords, const RenderOptions& scene);
/// Keys: those of CameraRequest and RenderOptions; "pose" of the free camera.
CameraRequest camera_request(const nb::dict& options, const RenderOptions& scene);
/// A rate in millionths of a hertz, exact where it has few decimals.
Rational rational(double rate);

}  // namespace gloam::python
