#pragma once
// Controller "gripper": opens and closes fingers together, with a limited force.

#include <memory>

#include "gloam/controller.h"
#include "gloam/drive/robot_goals.h"
#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

/// Drives all of a robot's (or part's) driven joints with limits between closed and open. A
/// SetJointGoal of one of them moves all of them to the same fraction of their ranges. Errors: no
/// driven joint with limits.
Result<std::unique_ptr<Controller>> make_gripper_controller(const CompiledWorld& world,
                                                            const RobotInstance& robot);

/// The first joint of such a gripper that takes goals; none if no joint has limits.
Result<RobotGoals> gripper_goals(const CompiledWorld& world, const RobotInstance& robot);

}  // namespace gloam
