#pragma once
// Bodies and geoms of a robot by their names, and poses of bodies at the present instant: mjData's
// own are those before the last step.

#include <mujoco/mujoco.h>

#include <string>

#include "policy/terms/terms.h"

namespace gloam {

/// A body by its name in the robot's own model; "" = the robot's root. Error: with the nearest.
Result<int> find_body(const TermBinding& binding, const std::string& name);

/// Full name of an element of a robot: with its prefix, if the name has none.
std::string full_name(const RobotInstance& robot, const std::string& name);

/// Names of all elements of a type that belong to the robot by their prefix.
std::vector<std::string> names_of(const mjModel& model, const RobotInstance& robot, mjtObj type);

/// Orientation of a body in the world from the joints' positions, wxyz.
void body_orientation(const mjModel& model, const mjData& data, int body, mjtNum q_WB[4]);

}  // namespace gloam
