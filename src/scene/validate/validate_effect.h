#pragma once
// What goes together in [[gas]], [[fire]] and [[smoke]]; ranges are checked elsewhere.

#include "gloam/scene.h"

namespace gloam {

Status validate_effects(const Scene& scene);

}  // namespace gloam
