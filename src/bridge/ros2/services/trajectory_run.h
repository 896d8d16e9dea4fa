#pragma once
// TrajectoryRun: one goal of FollowJointTrajectory: the simulation follows its trajectory, and the
// joints are watched in Snapshots.

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
                JointTrajectory trajectory);
  GoalEnd run(GoalContext& context);

 private:
  /// Largest errors; 0 = any.
  struct Tolerance {
    double position = 0, velocity = 0;
  };
  static std::vector<Tolerance> tolerances_of(const std::vector<control_msgs::JointTolerance>& list,
                                              const std::vector<std::string>& joints);

  Status begin(const Snapshot& now);
  Status find(const Snapshot& now);
  GoalEnd watch(GoalContext& context);
  // The end of the goal, if this is it. Before its first step: none.
  std::optional<GoalEnd> look(const Snapshot& now, GoalContext& context);
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
  const double stamp_;
  double settling_ = 0;      // [s]
  int64_t posted_step_ = 0;  // at or after which it starts
  int64_t start_step_ = -1;
  Rational rate_ = {0, 1};
  std::vector<Joint> joints_;
  std::unique_ptr<ControlLease> lease_;
};

}  // namespace gloam::bridge
