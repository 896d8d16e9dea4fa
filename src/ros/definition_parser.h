#pragma once
// Definitions of messages as text (ros2msg), of types that Gloam may not know.

#include "gloam/result.h"
#include "ros/type_description.h"

namespace gloam {

/// Reads the definition of the message `name` ("sensor_msgs/msg/Imu"), followed by those of its
/// parts as in MCAP. Types of fields are primitives or names of messages, which are not looked up
/// here (MessageSchema does). Errors name the line: no such syntax, a bound that is no number, a
/// name twice, wstring and other types without an encoding here, ROS 1's time and duration.
Result<TypeDescription> parse_ros2msg(std::string_view text, std::string_view name);

}  // namespace gloam
