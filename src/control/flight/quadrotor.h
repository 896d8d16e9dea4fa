#pragma once
// Controller "quadrotor": flies any multirotor whose rotors are actuators at sites.

#include <memory>

#include "gloam/controller.h"
#include "gloam/drive/robot_goals.h"
#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

/// Reads the base's true motion: state estimation is taken as perfect. Errors: a robot without a
/// free joint or without enough rotors.
Result<std::unique_ptr<Controller>> make_quadrotor_controller(const CompiledWorld& world,
                                                              const RobotInstance& robot);
Result<RobotGoals> quadrotor_goals(const CompiledWorld& world, const RobotInstance& robot);

}  // namespace gloam
