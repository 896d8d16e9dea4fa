#pragma once
// Parameters of the node: paused, speed, gravity, wind, and every option of the scene that may
// change while it runs (docs/ros2.md).

#include <string>
#include <vector>

#include "bridge/operations/operator.h"
#include "bridge/ros2/ros2_action.h"
#include "bridge/ros2/ros2_service.h"

namespace gloam::bridge {

/// Topic of changes that nodes share.
inline constexpr const char* kParameterEvents = "/parameter_events";

/// NODE/get_parameters and the others that rclcpp gives every node; `node`: its full name, "/sim/
/// gloam". `publish` is given the changes for kParameterEvents, rcl_interfaces/msg/ParameterEvent.
std::vector<Ros2Service> parameter_services(Operator& operations, const std::string& node,
                                            Ros2Publish publish);

}  // namespace gloam::bridge
