#pragma once
// The controllers that [robot.controller] type may name.

#include "gloam/controller.h"
#include "world/world.h"

namespace gloam {

/// The controller that a robot's options ask for; null for "none". Unknown names are refused with
/// the nearest valid one.
Result<std::unique_ptr<Controller>> make_controller(
    const std::shared_ptr<const CompiledWorld>& world, const RobotInstance& robot);

}  // namespace gloam
