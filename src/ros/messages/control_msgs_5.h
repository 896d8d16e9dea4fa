#pragma once
// The feedback of control_msgs' FollowJointTrajectory before version 6.3, as Humble, Jazzy and
// Kilted have it.

#include "ros/messages/control_msgs.h"

namespace gloam::control_msgs_5::action {

inline constexpr std::string_view kPackage = "control_msgs/action";

struct FollowJointTrajectory_Feedback {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  trajectory_msgs::JointTrajectoryPoint desired, actual, error;
  std::vector<std::string> multi_dof_joint_names;
  trajectory_msgs::MultiDOFJointTrajectoryPoint multi_dof_desired, multi_dof_actual,
      multi_dof_error;
  GLOAM_MESSAGE(FollowJointTrajectory_Feedback, header, joint_names, desired, actual, error,
                multi_dof_joint_names, multi_dof_desired, multi_dof_actual, multi_dof_error)
};

struct FollowJointTrajectory_FeedbackMessage {
  unique_identifier_msgs::UUID goal_id;
  FollowJointTrajectory_Feedback feedback;
  GLOAM_MESSAGE(FollowJointTrajectory_FeedbackMessage, goal_id, feedback)
};

}  // namespace gloam::control_msgs_5::action
