#pragma once
// Controller "diff_drive": turns a velocity goal into the speeds of left and right wheels.

#include <memory>

#include "gloam/controller.h"
#include "gloam/drive/robot_goals.h"
#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

/// Wheel speed = (vx -/+ yaw_rate track / 2) / radius, within limits of speed and acceleration; vy
/// is ignored. Bases with several wheels on each side skid when they turn, so that they turn more
/// slowly than the goal. Errors: no wheels on one side.
Result<std::unique_ptr<Controller>> make_diff_drive_controller(const CompiledWorld& world,
                                                               const RobotInstance& robot);
Result<RobotGoals> diff_drive_goals(const CompiledWorld& world, const RobotInstance& robot);

}  // namespace gloam
