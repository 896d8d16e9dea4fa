#pragma once
// The scene file's [sky] as a map of light from far away, and a sun.

#include "gloam/scene.h"
#include "world/lights/visual_light.h"
#include "world/render_description.h"

namespace gloam {

/// Sets the environment of `out->sky`; a clear sky's sun is appended to the lights. Errors: a
/// damaged picture, one that is not twice as wide as high, values that are not finite, black where
/// an illuminance is asked for.
Status author_sky(const SkyOptions& options, LightLevels* levels, RenderDescription* out);

}  // namespace gloam
