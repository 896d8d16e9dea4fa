#pragma once
// Skins: linear blend skinning (Magnenat-Thalmann et al. 1988) of the model's bones.

#include <mujoco/mujoco.h>

namespace gloam {

/// World positions of one skin's vertices [m] into `out`, (skin_vertnum x 3): each vertex is the
/// weighted mean of where its bones carry it from the bind pose; skins that inflate are then moved
/// out along the vertex normals. `xpos`, `xquat` = poses of the bodies.
void skin_vertices(const mjModel& model, int skin, const mjtNum* xpos, const mjtNum* xquat,
                   float* out);

}  // namespace gloam
