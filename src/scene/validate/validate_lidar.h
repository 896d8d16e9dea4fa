#pragma once
// What goes together in a [[lidar]]; ranges of single values are checked elsewhere.

#include "gloam/scene.h"

namespace gloam {

Status validate_lidar(const LidarOptions& lidar);

}  // namespace gloam
