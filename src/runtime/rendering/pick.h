#pragma once
// Object under a pixel.

#include "gloam/simulation.h"
#include "instant/pose_frame.h"
#include "runtime/rendering/shared_renderer.h"

namespace gloam {

/// In the picture `frame`, at (u, v) [px], of what is drawn at `poses`. Error: nothing is there.
Result<PickResult> pick_at(SharedRenderer& shared, const PoseFrame& poses, const CameraFrame& frame,
                           double u, double v);

}  // namespace gloam
