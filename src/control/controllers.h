#pragma once
// The list of controllers: the names that [robot.controller] type may have.

#include "sim/loop/controller.h"

namespace gloam {

/// The controller that a robot's options ask for; null for "none". Unknown names are refused with
/// the nearest valid one.
Result<std::unique_ptr<Controller>> make_controller(const CompiledWorld& world,
                                                    const RobotInstance& robot);

}  // namespace gloam
