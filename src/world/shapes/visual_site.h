#pragma once
// Sites as MuJoCo's viewer shows them, where the scene asks for it.

#include <mujoco/mujoco.h>

#include "world/materials/visual_material.h"
#include "world/render_description.h"
#include "world/visual_label.h"

namespace gloam {

inline constexpr int kFirstHiddenGroup = 3;  ///< first group that MuJoCo's viewer hides at first

/// True if the scene draws a group: those that it lists, else those that MuJoCo shows at first.
bool draws_group(const RenderOptions& render, int group);

/// Adds an instance for every site of the groups that are drawn, if the scene draws sites. Sites
/// are marks, not things: colour pictures alone show them, and they cast no shadow.
void describe_sites(const CompiledWorld& world, MaterialTable* materials, LabelTable* labels,
                    RenderDescription* out);

}  // namespace gloam
