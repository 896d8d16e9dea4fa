#pragma once
// Requests of pictures out of Python's keyword arguments.

#include "core.h"
#include "gloam/camera_stream.h"

namespace gloam::python {

RenderOptions render_options(Keywords& keywords);
/// Keys: those of CameraRequest and RenderOptions; "pose" of the free camera.
CameraRequest camera_request(const nb::dict& options);
/// A rate in millionths of a hertz, exact where it has few decimals.
Rational rational(double rate);

}  // namespace gloam::python
