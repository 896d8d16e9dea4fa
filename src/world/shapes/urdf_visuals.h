#pragma once

#include "world/compile/level.h"

namespace gloam {

/// The visuals of the scene's URDF robots, which stock loading discards: a second, static model and
/// where its geoms sit on the bodies of the first. What cannot be drawn goes to `unsupported`, it
/// is never an error. Fills visual_model, visual_only, unsupported.
void add_urdf_visuals(const Scene& scene, ModelFiles* files, CompiledWorld* world);

}  // namespace gloam
