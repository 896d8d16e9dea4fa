#pragma once
// The controllers that [robot.controller] type may name.

#include "gloam/controller.h"
#include "gloam/drive/robot_goals.h"
#include "sim/loop/controller_slot.h"
#include "world/world.h"

namespace gloam {

/// The controller that a robot's options ask for; null for "none". Unknown names are refused with
/// the nearest valid one.
Result<std::unique_ptr<Controller>> make_controller(
    const std::shared_ptr<const CompiledWorld>& world, const RobotInstance& robot);

/// Goals that such a controller accepts. Errors: as for its creation.
Result<RobotGoals> controller_goals(const CompiledWorld& world, const RobotInstance& robot);

/// Whether a log contains the controls of this controller (ControllerTraits::is_logged).
bool has_logged_controls(const ControllerOptions& options);

/// The same with other options than the scene's: a ControllerMaker.
Result<std::unique_ptr<Controller>> make_robot_controller(
    const std::shared_ptr<const CompiledWorld>& world, int robot, const ControllerOptions& options);

/// Makes everything of a robot that this module implements.
RobotMakers robot_makers();
/// The same for the replay of a log: without controllers whose controls the log contains.
RobotMakers replay_makers();

}  // namespace gloam
