#pragma once
// The surfaces of waters as rows of the render description: meshes whose vertices follow the waves.

#include <vector>

#include "world/effects/water_description.h"
#include "world/render_description.h"
#include "world/visual_label.h"

namespace gloam {

/// Vertices of a water in PoseFrame::vertices, rows along y; those of waters follow, in their
/// order, all that is the model's (deformable_layout.h).
int water_vertices(const WaterDescription& water);

/// Appends a material and a deformable for each water. `first_vertex` = the model's.
void author_waters(const std::vector<WaterDescription>& waters, int first_vertex,
                   LabelTable* labels, RenderDescription* out);

}  // namespace gloam
