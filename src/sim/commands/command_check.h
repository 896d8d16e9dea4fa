#pragma once
// What a Command may say, checked on the thread that posts it.

#include <mujoco/mujoco.h>

#include "gloam/command.h"
#include "world/world.h"

namespace gloam {

/// The free joint that carries `body` (its own or that of the floating base it hangs from), or -1.
int floating_joint(const mjModel& model, int body);

/// Refuses handles of nothing and of other Worlds, numbers that are not finite, and effects the
/// model cannot show.
Status check_command(const CompiledWorld& world, const Command& command);

}  // namespace gloam
