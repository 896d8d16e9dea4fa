#pragma once
// Holds a robot's joints at angles.

#include "gloam/controller.h"
#include "world/world.h"

namespace gloam {

/// PD control of every joint that one actuator drives: motors get the torque
/// kp (q* - q) - kd v within their limits, position servos get q* and use gains of their own.
/// Targets: ControllerOptions::target, one per driven joint in the order of the actuators; empty =
/// the angles the simulation starts from (its keyframe). Errors: nothing to drive, wrong number of
/// targets, gains that are not finite or negative.
Result<std::unique_ptr<Controller>> make_joint_position_controller(const CompiledWorld& world,
                                                                   const RobotInstance& robot);

}  // namespace gloam
