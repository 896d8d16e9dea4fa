#pragma once
// Messages of ROS 2's package nav_msgs.

#include "ros/messages/geometry_msgs.h"

namespace gloam::nav_msgs {

inline constexpr std::string_view kPackage = "nav_msgs/msg";

/// The pose in header.frame_id, the twist in child_frame_id.
struct Odometry {
  std_msgs::Header header;
  std::string child_frame_id;
  geometry_msgs::PoseWithCovariance pose;
  geometry_msgs::TwistWithCovariance twist;
  GLOAM_MESSAGE(Odometry, header, child_frame_id, pose, twist)
};

struct Path {
  std_msgs::Header header;
  std::vector<geometry_msgs::PoseStamped> poses;
  GLOAM_MESSAGE(Path, header, poses)
};

}  // namespace gloam::nav_msgs
