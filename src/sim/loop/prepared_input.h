#pragma once
// PreparedInput: the parts of a Command that take memory or time to make. They are made on the
// thread that posts it; the sim thread swaps them in, and gives back here what they replace.

#include <memory>

#include "gloam/command.h"
#include "sim/joints/joint_inputs.h"
#include "sim/loop/controller_slot.h"

namespace gloam {

struct PreparedInput {
  ControllerSlot controller;       ///< of SetController
  NextTrajectory trajectory = {};  ///< of FollowTrajectory
};

/// Null for Commands that need none. Errors: of the controller's options, its rate, the trajectory.
Result<std::unique_ptr<PreparedInput>> prepare_input(
    const std::shared_ptr<const CompiledWorld>& world, const Command& command, Rational timestep,
    const ControllerMaker& make);

}  // namespace gloam
