#pragma once
// What a Command may say, checked on the thread that posts it.

#include <mujoco/mujoco.h>

#include "gloam/command.h"
#include "world/world.h"
#include "world/world_robots.h"

namespace gloam {

/// Refuses handles of nothing and of other Worlds, numbers that are not finite, and effects the
/// model cannot show.
Status check_command(const CompiledWorld& world, const Command& command);

}  // namespace gloam
