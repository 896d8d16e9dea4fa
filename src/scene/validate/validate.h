#pragma once
// Checks that no option alone can fail: names that clash, options that exclude each other. Ranges
// are checked here too, because scenes made in code have passed no reader.

#include "gloam/scene.h"

namespace gloam {

Status validate_scene(const Scene& scene);

}  // namespace gloam
