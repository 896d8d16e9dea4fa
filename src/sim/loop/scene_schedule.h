#pragma once
// What the scene itself says about later times: velocity goals of its controllers, pushes. They
// become Commands at exact steps and apply anew after every reset.

#include <vector>

#include "gloam/command.h"
#include "world/world.h"

namespace gloam {

/// Commands in order of their step; those of one step in source order, goals before pushes. `time`
/// in the scene -> the first step at or after it. Errors name the line: unknown body, a body that
/// does not float, a time that is negative or not finite.
Result<std::vector<Command>> scene_schedule(const CompiledWorld& world, Rational timestep);

}  // namespace gloam
