#pragma once
// Checks that options of [[gas]], [[fire]] and [[smoke]] go together; ranges are checked elsewhere.

#include "gloam/scene.h"

namespace gloam {

Status validate_effects(const Scene& scene);

}  // namespace gloam
