#pragma once
// The scene's [blackout] on the lamps of the render description.

#include "gloam/scene.h"
#include "world/render_description.h"

namespace gloam {

/// Cuts the mains of all lamps and all that glows but the sky's sun; ambient light, which stands
/// for what lamps send by way of walls, goes with the headlight. Call when lamps and materials are
/// complete. Errors: an exact name that nothing has.
Status author_blackout(const BlackoutOptions& options, RenderDescription* out);

}  // namespace gloam
