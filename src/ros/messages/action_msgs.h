#pragma once
// Messages and the service of ROS 2's package action_msgs: goals of action servers.

#include "ros/messages/builtin_interfaces.h"
#include "ros/messages/unique_identifier_msgs.h"

namespace gloam::action_msgs {

inline constexpr std::string_view kPackage = "action_msgs/msg";

struct GoalInfo {
  unique_identifier_msgs::UUID goal_id;
  builtin_interfaces::Time stamp;  ///< when it was accepted
  GLOAM_MESSAGE(GoalInfo, goal_id, stamp)
};

struct GoalStatus {
  GoalInfo goal_info;
  int8_t status = 0;
  GLOAM_CONSTANTS(int8, STATUS_UNKNOWN = 0, STATUS_ACCEPTED = 1, STATUS_EXECUTING = 2,
                  STATUS_CANCELING = 3, STATUS_SUCCEEDED = 4, STATUS_CANCELED = 5,
                  STATUS_ABORTED = 6)
  GLOAM_MESSAGE(GoalStatus, goal_info, status)
};

struct GoalStatusArray {
  std::vector<GoalStatus> status_list;
  GLOAM_MESSAGE(GoalStatusArray, status_list)
};

namespace srv {

inline constexpr std::string_view kPackage = "action_msgs/srv";

/// Zeros mean any: no id and no stamp = all goals; a stamp = those accepted until then.
struct CancelGoal_Request {
  GoalInfo goal_info;
  GLOAM_MESSAGE(CancelGoal_Request, goal_info)
};

struct CancelGoal_Response {
  int8_t return_code = 0;
  std::vector<GoalInfo> goals_canceling;
  GLOAM_CONSTANTS(int8, ERROR_NONE = 0, ERROR_REJECTED = 1, ERROR_UNKNOWN_GOAL_ID = 2,
                  ERROR_GOAL_TERMINATED = 3)
  GLOAM_MESSAGE(CancelGoal_Response, return_code, goals_canceling)
};

}  // namespace srv
}  // namespace gloam::action_msgs
