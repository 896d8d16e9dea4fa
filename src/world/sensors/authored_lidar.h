#pragma once
// The scene file's [[lidar]] tables on the compiled model's bodies, without MuJoCo types.

#include <vector>

#include "base/vec.h"
#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

struct CompiledWorld;

struct LidarDescription {
  LidarOptions options;
  int body = 0;  ///< body that it moves with
  Pose X_BL;
  std::vector<uint8_t> hidden = {};  ///< flags by body: its beams pass it; empty = none
};

/// Error: no such body, with the nearest name.
Result<std::vector<LidarDescription>> describe_lidars(const CompiledWorld& world);

}  // namespace gloam
