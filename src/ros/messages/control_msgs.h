#pragma once
// The action FollowJointTrajectory of ROS 2's package control_msgs, as of its version 6.3; before,
// its feedback had no indices (control_msgs_5.h).

#include "ros/messages/action_msgs.h"
#include "ros/messages/trajectory_msgs.h"

namespace gloam::control_msgs {

inline constexpr std::string_view kPackage = "control_msgs/msg";

/// 0 = the default, -1 = any.
struct JointTolerance {
  std::string name;
  double position = 0, velocity = 0, acceleration = 0;
  GLOAM_MESSAGE(JointTolerance, name, position, velocity, acceleration)
};

struct JointComponentTolerance {
  std::string joint_name;
  uint16_t component = 0;
  double position = 0, velocity = 0, acceleration = 0;
  GLOAM_CONSTANTS(uint16, X_AXIS = 1, Y_AXIS = 2, Z_AXIS = 3, TRANSLATION = 4, ROTATION = 5)
  GLOAM_MESSAGE(JointComponentTolerance, joint_name, component, position, velocity, acceleration)
};

namespace action {

inline constexpr std::string_view kPackage = "control_msgs/action";

struct FollowJointTrajectory_Goal {
  trajectory_msgs::JointTrajectory trajectory;
  trajectory_msgs::MultiDOFJointTrajectory multi_dof_trajectory;
  std::vector<JointTolerance> path_tolerance;
  std::vector<JointComponentTolerance> component_path_tolerance;
  std::vector<JointTolerance> goal_tolerance;
  std::vector<JointComponentTolerance> component_goal_tolerance;
  builtin_interfaces::Duration goal_time_tolerance;
  GLOAM_MESSAGE(FollowJointTrajectory_Goal, trajectory, multi_dof_trajectory, path_tolerance,
                component_path_tolerance, goal_tolerance, component_goal_tolerance,
                goal_time_tolerance)
};

struct FollowJointTrajectory_Result {
  int32_t error_code = 0;
  std::string error_string;
  GLOAM_CONSTANTS(int32, SUCCESSFUL = 0, INVALID_GOAL = -1, INVALID_JOINTS = -2,
                  OLD_HEADER_TIMESTAMP = -3, PATH_TOLERANCE_VIOLATED = -4,
                  GOAL_TOLERANCE_VIOLATED = -5)
  GLOAM_MESSAGE(FollowJointTrajectory_Result, error_code, error_string)
};

struct FollowJointTrajectory_Feedback {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  trajectory_msgs::JointTrajectoryPoint desired, actual, error;
  int32_t index = 0;  ///< of the segment that is followed
  std::vector<std::string> multi_dof_joint_names;
  trajectory_msgs::MultiDOFJointTrajectoryPoint multi_dof_desired, multi_dof_actual,
      multi_dof_error;
  int32_t multi_dof_index = 0;
  GLOAM_MESSAGE(FollowJointTrajectory_Feedback, header, joint_names, desired, actual, error, index,
                multi_dof_joint_names, multi_dof_desired, multi_dof_actual, multi_dof_error,
                multi_dof_index)
};

struct FollowJointTrajectory_SendGoal_Request {
  unique_identifier_msgs::UUID goal_id;
  FollowJointTrajectory_Goal goal;
  GLOAM_MESSAGE(FollowJointTrajectory_SendGoal_Request, goal_id, goal)
};
struct FollowJointTrajectory_SendGoal_Response {
  bool accepted = false;
  builtin_interfaces::Time stamp;
  GLOAM_MESSAGE(FollowJointTrajectory_SendGoal_Response, accepted, stamp)
};
struct FollowJointTrajectory_GetResult_Request {
  unique_identifier_msgs::UUID goal_id;
  GLOAM_MESSAGE(FollowJointTrajectory_GetResult_Request, goal_id)
};
struct FollowJointTrajectory_GetResult_Response {
  int8_t status = 0;
  FollowJointTrajectory_Result result;
  GLOAM_MESSAGE(FollowJointTrajectory_GetResult_Response, status, result)
};
struct FollowJointTrajectory_FeedbackMessage {
  unique_identifier_msgs::UUID goal_id;
  FollowJointTrajectory_Feedback feedback;
  GLOAM_MESSAGE(FollowJointTrajectory_FeedbackMessage, goal_id, feedback)
};

}  // namespace action
}  // namespace gloam::control_msgs
