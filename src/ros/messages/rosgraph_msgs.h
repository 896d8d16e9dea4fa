#pragma once
// Messages of ROS 2's package rosgraph_msgs.

#include "ros/messages/builtin_interfaces.h"

namespace gloam::rosgraph_msgs {

inline constexpr std::string_view kPackage = "rosgraph_msgs/msg";

struct Clock {
  builtin_interfaces::Time clock;  ///< simulation time
  GLOAM_MESSAGE(Clock, clock)
};

}  // namespace gloam::rosgraph_msgs
