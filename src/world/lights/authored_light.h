#pragma once
// The scene file's [[light]] tables as rows of the render description.

#include <vector>

#include "world/lights/visual_light.h"
#include "world/render_description.h"
#include "world/visual_label.h"

namespace gloam {

/// Appends lamps to `out`: point, spot and directional lights to its lights; the others are drawn
/// things that shine, without a geom. `poses` = X_WB at qpos0, `is_static` per body. Reads the
/// files that the tables name, each once. Errors: no such body, a damaged file, a schedule out of
/// order.
Status author_lights(const CompiledWorld& world, const std::vector<Affine3f>& poses,
                     const std::vector<bool>& is_static, LabelTable* labels, LightLevels* levels,
                     RenderDescription* out);

}  // namespace gloam
