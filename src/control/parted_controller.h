#pragma once
// The controller of a robot whose parts have controllers of their own ([[robot.part]]).

#include <memory>
#include <string>
#include <vector>

#include "gloam/controller.h"
#include "world/world.h"

namespace gloam {

/// A robot with the controller of one of its parts, and the actuators that this controller drives.
struct ControlledPart {
  std::string name;  ///< "" = the robot's own controller, on all joints that no part drives
  RobotInstance robot;
};

/// The robot's own controller first, then its parts in their order. Errors: parts without driven
/// joints, or that share a joint.
Result<std::vector<ControlledPart>> robot_parts(const mjModel& model, const RobotInstance& robot);

/// Runs the robot's own controller on all joints that no part drives, and the parts' controllers at
/// their own rates, which must divide the robot's. Errors: as for robot_parts().
Result<std::unique_ptr<Controller>> make_parted_controller(
    const std::shared_ptr<const CompiledWorld>& world, const RobotInstance& robot);

}  // namespace gloam
