#pragma once
// TrajectoryRun: one goal of FollowJointTrajectory. It posts the trajectory, as the topic
// joint_trajectory does, and watches the joints in Snapshots. It does not claim the robot: any
// other command for one of the joints ends the goal.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridge/ros2/services/action_server.h"
#include "gloam/joints/joint_trajectory.h"
#include "gloam/simulation.h"
#include "ros/messages/control_msgs.h"

namespace gloam::bridge {

/// Hinges and slides of a robot in the World of a Snapshot, by their own names or full ones.
/// Errors: those of check_joint_names(), no such joint, one joint by two names.
Result<std::vector<Joint>> find_joints(const Snapshot& snapshot, const std::string& robot,
                                       const std::vector<std::string>& names);

/// The end of a goal. `code`: of FollowJointTrajectory_Result.
GoalEnd trajectory_end(int8_t status, int32_t code, std::string text);

class TrajectoryRun {
 public:
  TrajectoryRun(Simulation& simulation, std::string robot, int interfaces,
                const control_msgs::action::FollowJointTrajectory_Goal& goal,
                JointTrajectory trajectory, const GoalId& id);
  GoalEnd run(GoalContext& context);

 private:
  /// Largest errors; 0 = any.
  struct Tolerance {
    double position = 0, velocity = 0;
  };
  static std::vector<Tolerance> tolerances_of(const std::vector<control_msgs::JointTolerance>& list,
                                              const std::vector<std::string>& joints);

  std::optional<GoalEnd> begin(const Snapshot& now);
  Status find(const Snapshot& now);
  GoalEnd watch(GoalContext& context);
  // Its end if its client or a newer goal asks for it.
  static std::optional<GoalEnd> asked_end(const GoalContext& context);
  // The end of the goal, if this is it. Before its first step: none.
  std::optional<GoalEnd> look(const Snapshot& now, GoalContext& context);
  // Its joints that still follow its trajectory hold their positions.
  void stop();
  bool is_own(const std::shared_ptr<const ActiveTrajectory>& active) const {
    return active != nullptr && active->tag == tag_;
  }
  std::optional<GoalEnd> end_of(const Snapshot& now, const ActiveTrajectory& path) const;
  std::string joint_beyond(const Snapshot& now, const ActiveTrajectory& path,
                           const std::vector<Tolerance>& allowed) const;
  void tell(const Snapshot& now, const ActiveTrajectory& path, GoalContext& context);

  Simulation& simulation_;
  const std::string robot_;
  const int interfaces_;
  const std::vector<std::string> names_;
  const JointTrajectory trajectory_;
  const trajectory_msgs::JointTrajectory message_;
  const std::vector<Tolerance> path_, goal_;
  const int64_t tag_;         // of the trajectory in Snapshots
  double settling_ = 0;       // [s]
  int64_t latest_start_ = 0;  // step before which it starts at the latest
  bool is_posted_ = false;
  std::vector<Joint> joints_;
};

}  // namespace gloam::bridge
