#pragma once
// Lights, sky and exposure of a model.

#include <mujoco/mujoco.h>

#include <vector>

#include "base/vec.h"
#include "world/render_description.h"
#include "world/visual_material.h"

namespace gloam {

/// Fills lights (headlight last), sky and ev100. `poses` = X_WB at qpos0.
void describe_light(const mjModel& model, const std::vector<Affine3f>& poses,
                    MaterialTable* materials, RenderDescription* out);

}  // namespace gloam
