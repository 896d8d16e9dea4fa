#pragma once
// The controller type "policy".

#include "gloam/controller.h"
#include "policy/network.h"
#include "world/world.h"

namespace gloam {

/// A controller that runs the networks named in the robot's options. `loader` reads them.
Result<std::unique_ptr<Controller>> make_policy_controller(const CompiledWorld& world,
                                                           const RobotInstance& robot,
                                                           NetworkLoader loader);
Result<std::unique_ptr<Controller>> make_policy_controller(const CompiledWorld& world,
                                                           const RobotInstance& robot);

/// Control periods of a policy in steps of a simulation. Error: they are not whole steps.
Result<int64_t> steps_per_action(double rate, double timestep);

}  // namespace gloam
