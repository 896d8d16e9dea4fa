#pragma once
// Skins and flexes: meshes whose vertices move every instant.

#include <mujoco/mujoco.h>

#include <vector>

#include "base/vec.h"
#include "world/render_description.h"
#include "world/visual_label.h"
#include "world/visual_material.h"

namespace gloam {

/// Adds a deformable and an instance for every skin and every material of every flex. Vertices of
/// PoseFrame: those of all skins, then those of all flexes, in the model's order. Flexes of
/// dimension 1 (cables) have no surface and are listed in `unsupported`. `poses` = X_WB at qpos0.
void describe_deformables(const mjModel& model, const std::vector<Affine3f>& poses,
                          MaterialTable* materials, LabelTable* labels, RenderDescription* out);

}  // namespace gloam
