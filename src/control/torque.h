#pragma once
// Constant torques: for tests, and for clients that send controls themselves.

#include "gloam/controller.h"
#include "world/world.h"

namespace gloam {

/// Sets the torque of every joint that one motor drives once, at the start of each run;
/// from then on SetControl Commands have the last word. Torques: ControllerOptions::target [N m or
/// N], one per motor in the order of the actuators, within the actuators' limits; empty = all zero.
/// Errors: no motors, wrong number of torques.
Result<std::unique_ptr<Controller>> make_torque_controller(const CompiledWorld& world,
                                                           const RobotInstance& robot);

}  // namespace gloam
