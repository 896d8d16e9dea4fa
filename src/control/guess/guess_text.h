#pragma once
// The [[robot]] that `gloam robots --guess` proposes, as text.

#include <string>
#include <vector>

#include "control/guess/robot_shape.h"

namespace gloam {

/// The controller of the proposal.
struct GuessedController {
  std::string type = "none";
  std::vector<std::string> reasons = {};  ///< comments above the section
  RobotJoints joints = {};                ///< names without the robot's prefix
};

/// The first controller of this program that fits the shape and accepts the robot, with the reasons
/// against others that were tried.
GuessedController guess_controller(const CompiledWorld& world, const RobotTree& tree,
                                   const RobotShape& shape);

/// Name of a model's element without the robot's prefix; "" if it has none.
std::string own_name(const CompiledWorld& world, mjtObj type, int id);

/// `options` and the controller as a section of a scene; `comments` stand above it.
std::string guess_text(const RobotOptions& options, const std::vector<std::string>& comments,
                       const GuessedController& controller);

}  // namespace gloam
