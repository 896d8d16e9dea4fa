#pragma once
// The models of a robot's actuators, between its controls and MuJoCo: docs/actuators.md.

#include "control/actuators/actuator_network.h"
#include "sim/loop/actuator_layer.h"
#include "world/world.h"

namespace gloam {

/// Null: the robot has no [[robot.actuator]]. Errors: as for find_drives(), with the location in
/// the scene file. ActuatorLayer::begin(), which has the timestep, returns errors of the models.
Result<std::unique_ptr<ActuatorLayer>> make_actuators(
    const CompiledWorld& world, const RobotInstance& robot,
    ActuatorNetworkLoader load_network = load_actuator_network);

}  // namespace gloam
