#pragma once
// Checks of people and vehicles of a scene beyond the ranges of their options.

#include "gloam/scene.h"

namespace gloam {

/// Errors: names that bodies or others have, a behaviour without what it needs.
Status validate_agents(const Scene& scene);

}  // namespace gloam
