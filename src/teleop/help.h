#pragma once
// The table of keys and buttons.

#include <string>
#include <vector>

#include "gloam/drive/robot_goals.h"

namespace gloam::teleop {

/// Lines of at most 78 columns; rows for axes that the robot lacks are
/// left out. `moves_frame`: keys move the goal of a frame.
std::vector<std::string> help_lines(const std::string& robot, const RobotGoals& goals,
                                    bool moves_frame);

}  // namespace gloam::teleop
