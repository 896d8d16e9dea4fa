#pragma once
// MuJoCo turns a mesh into the frame of its inertia. Solid patterns (the grain of wood, courses of
// brick) are meant in the frame that the mesh was drawn in.

#include <mujoco/mujoco.h>

#include "world/render_description.h"

namespace gloam {

/// Brings the meshes of geoms whose material has a pattern, and no texture, back into their own
/// frame: the same place in the world, another X_BG. Call when materials are complete.
void restore_authored_frames(const mjModel& model, RenderDescription* out);

}  // namespace gloam
