#pragma once
// Skins, flexes and spatial tendons: meshes whose vertices move every instant.

#include <mujoco/mujoco.h>

#include <vector>

#include "base/vec.h"
#include "world/materials/visual_material.h"
#include "world/render_description.h"
#include "world/visual_label.h"

namespace gloam {

/// Adds a deformable and an instance for every skin, every material of every flex and every tendon
/// with a path; their vertices in PoseFrame: world/shapes/deformable_layout.h. `poses` = X_WB at
/// qpos0.
void describe_deformables(const mjModel& model, const std::vector<Affine3f>& poses,
                          MaterialTable* materials, LabelTable* labels, RenderDescription* out);

}  // namespace gloam
