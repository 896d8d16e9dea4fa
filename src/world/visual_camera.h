#pragma once
// Cameras of a model, in pixels.

#include <mujoco/mujoco.h>

#include "world/render_description.h"

namespace gloam {

/// All cameras of the model, then the free camera "free" as MuJoCo's viewer first shows it.
void describe_cameras(const mjModel& model, RenderDescription* out);

}  // namespace gloam
