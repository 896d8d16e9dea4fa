#pragma once
// The scene file's [[volume]] and [[gas]] tables as rows of the render description.

#include <vector>

#include "gloam/scene.h"
#include "world/effects/gas_description.h"
#include "world/render_description.h"

namespace gloam {

/// Appends media and volumes; volumes of one preset share its medium. Errors: no such medium, a
/// medium too clear for a visibility, a damaged grid, grids of different shapes, too many voxels.
Status author_volumes(const std::vector<VolumeOptions>& options, RenderDescription* out);

/// Appends a volume for each gas that is solved for, clear until the simulation says otherwise.
void author_gases(const std::vector<GasDescription>& gases, RenderDescription* out);

}  // namespace gloam
