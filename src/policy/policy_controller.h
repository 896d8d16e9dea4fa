#pragma once
// The controller type "policy".

#include <optional>

#include "gloam/controller.h"
#include "gloam/drive/robot_goals.h"
#include "gloam/joints/policy.h"
#include "policy/network.h"
#include "world/world.h"

namespace gloam {

/// A controller that runs the networks named in the robot's options. `loader` reads them.
Result<std::unique_ptr<Controller>> make_policy_controller(const CompiledWorld& world,
                                                           const RobotInstance& robot,
                                                           NetworkLoader loader);
Result<std::unique_ptr<Controller>> make_policy_controller(const CompiledWorld& world,
                                                           const RobotInstance& robot);

/// Velocities within the command ranges of the policy. Errors: as for Policy::load().
Result<RobotGoals> policy_goals(const CompiledWorld& world, const RobotInstance& robot);

/// State of a robot's controller if it is a policy.
std::optional<PolicyState> state_of_policy(const Controller& controller);

/// Control periods of a policy in steps of a simulation. Error: they are not whole steps.
Result<int64_t> steps_per_action(double rate, double timestep);

}  // namespace gloam
