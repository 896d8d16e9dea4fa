#pragma once
// Checks that options of a [[lidar]] go together; ranges of single values are checked elsewhere.

#include "gloam/scene.h"

namespace gloam {

Status validate_lidar(const LidarOptions& lidar);

}  // namespace gloam
