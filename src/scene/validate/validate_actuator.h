#pragma once
// Rules between the options of [robot.actuators] and [[robot.actuator]].

#include "gloam/scene.h"

namespace gloam {

Status validate_actuators(const RobotOptions& robot);

}  // namespace gloam
