#pragma once
// Rules that every trajectory of joints follows, those of ros2_controllers'
// joint_trajectory_controller, for the action and for topics.

#include <span>
#include <string>

#include "gloam/result.h"
#include "ros/messages/trajectory_msgs.h"

namespace gloam {

/// Errors: no names, an empty one, one that is there twice.
Status check_joint_names(std::span<const std::string> names);
/// Errors: no points, or too many; times that are negative or do not increase; a point without one
/// position for each joint, or with velocities, accelerations or efforts that are neither none nor
/// one for each joint; numbers that are not finite.
Status check_points(const trajectory_msgs::JointTrajectory& trajectory);

}  // namespace gloam
