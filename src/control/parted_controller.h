#pragma once
// The controller of a robot whose parts have controllers of their own ([[robot.part]]).

#include <memory>

#include "gloam/controller.h"
#include "world/world.h"

namespace gloam {

/// Runs the robot's own controller on all joints that no part drives, and the parts' controllers at
/// their own rates, which must divide the robot's. Errors: parts without driven joints, or that
/// share a joint.
Result<std::unique_ptr<Controller>> make_parted_controller(
    const std::shared_ptr<const CompiledWorld>& world, const RobotInstance& robot);

}  // namespace gloam
