#pragma once
// Messages of ROS 2's package tf2_msgs.

#include "ros/messages/geometry_msgs.h"

namespace gloam::tf2_msgs {

inline constexpr std::string_view kPackage = "tf2_msgs/msg";

struct TFMessage {
  std::vector<geometry_msgs::TransformStamped> transforms;
  GLOAM_MESSAGE(TFMessage, transforms)
};

}  // namespace gloam::tf2_msgs
