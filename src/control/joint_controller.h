#pragma once
// Controllers of single joints: position, velocity and effort.

#include "gloam/controller.h"
#include "world/world.h"

namespace gloam {

/// One law for every joint that one actuator drives, as in the drivers of motors:
///   torque = kp (q* - q) + kd (v* - v) + effort
/// within the actuator's limits. Motors get the torque; a servo gets the control with which its own
/// law gives it, or its target where it uses gains of its own. Targets: ControlInputs, with gains
/// of ControllerOptions where they have none. The types differ in what stands for a missing target.
///
/// joint_position: q* = ControllerOptions::target, one per joint in the order of the actuators;
/// empty = the position at which it starts (the keyframe); v* = 0. Position servos use gains of
/// their own.
Result<std::unique_ptr<Controller>> make_joint_position_controller(const CompiledWorld& world,
                                                                   const RobotInstance& robot);
/// joint_velocity: q* = the integral of v* since the start, so kp is the integral gain of a PI
/// controller and 0 leaves damping only; v* = 0. kp (q* - q) stays within the limits of the
/// actuator's force (no windup). Servos of velocity get v*, those of position q*.
Result<std::unique_ptr<Controller>> make_joint_velocity_controller(const CompiledWorld& world,
                                                                   const RobotInstance& robot);
/// joint_effort: terms without a target are 0; a target of position implies v* = 0.
Result<std::unique_ptr<Controller>> make_joint_effort_controller(const CompiledWorld& world,
                                                                 const RobotInstance& robot);
// Errors of all: nothing to drive, an actuator with gear 0, wrong number of targets, gains that are
// not finite or negative.

}  // namespace gloam
