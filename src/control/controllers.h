#pragma once
// The list of controllers: from a robot's options to the thing that drives it.

#include <memory>

#include "gloam/result.h"
#include "sim/controller.h"
#include "world/world.h"

namespace gloam {

/// Error: unknown type, or the robot does not fit it.
Result<std::unique_ptr<Controller>> make_controller(const CompiledWorld& world, const RobotInstance& robot);

}  // namespace gloam
