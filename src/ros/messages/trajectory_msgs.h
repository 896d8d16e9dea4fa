#pragma once
// Messages of ROS 2's package trajectory_msgs.

#include "ros/messages/geometry_msgs.h"

namespace gloam::trajectory_msgs {

inline constexpr std::string_view kPackage = "trajectory_msgs/msg";

/// One value a joint, or none.
struct JointTrajectoryPoint {
  std::vector<double> positions;      ///< [rad or m]
  std::vector<double> velocities;     ///< [rad/s or m/s]
  std::vector<double> accelerations;  ///< [rad/s^2 or m/s^2]
  std::vector<double> effort;         ///< [N m or N]
  builtin_interfaces::Duration time_from_start;
  GLOAM_MESSAGE(JointTrajectoryPoint, positions, velocities, accelerations, effort, time_from_start)
};

struct JointTrajectory {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  std::vector<JointTrajectoryPoint> points;
  GLOAM_MESSAGE(JointTrajectory, header, joint_names, points)
};

/// One value a joint, or none.
struct MultiDOFJointTrajectoryPoint {
  std::vector<geometry_msgs::Transform> transforms;
  std::vector<geometry_msgs::Twist> velocities;
  std::vector<geometry_msgs::Twist> accelerations;
  builtin_interfaces::Duration time_from_start;
  GLOAM_MESSAGE(MultiDOFJointTrajectoryPoint, transforms, velocities, accelerations,
                time_from_start)
};

struct MultiDOFJointTrajectory {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  std::vector<MultiDOFJointTrajectoryPoint> points;
  GLOAM_MESSAGE(MultiDOFJointTrajectory, header, joint_names, points)
};

}  // namespace gloam::trajectory_msgs
