#pragma once
// The bodies that a camera or LiDAR does not see.

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// Flags by body: it or one above it fits one of the patterns; empty = there are no patterns.
/// `owner`, `loc`: who hides them, for errors. Errors: a pattern that fits none.
Result<std::vector<uint8_t>> hidden_bodies(const mjModel& model,
                                           const std::vector<std::string>& patterns,
                                           const std::string& owner, const SourceLoc& loc);

}  // namespace gloam
