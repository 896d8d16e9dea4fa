#pragma once
// TrajectoryRun: one goal of FollowJointTrajectory while it is followed: goals of the joints are
// posted a little ahead, the joints watched in Snapshots.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridge/ros2/services/action_server.h"
#include "bridge/ros2/services/joint_way.h"
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
                const control_msgs::action::FollowJointTrajectory_Goal& goal, JointWay way);
  GoalEnd run(GoalContext& context);

 private:
  /// Largest errors; 0 = any.
  struct Tolerance {
    double position = 0, velocity = 0;
  };
  static std::vector<Tolerance> tolerances_of(const std::vector<control_msgs::JointTolerance>& list,
                                              const std::vector<std::string>& joints);

  Status begin(const Snapshot& now);
  // The trajectory starts here, from the present positions.
  void start(const Snapshot& now);
  Status find(const Snapshot& now);
  // The goals of the next moment that were not posted yet.
  Status post_ahead(const Snapshot& now);
  // Stands still where it is; goals that are under way come first.
  GoalEnd cancelled(const Snapshot& now);
  // The end of the goal, if this is it.
  std::optional<GoalEnd> look(const Snapshot& now, GoalContext& context);
  std::string joint_beyond(const Snapshot& now, const JointWayPoint& desired,
                           const std::vector<Tolerance>& allowed) const;
  void tell(const Snapshot& now, const JointWayPoint& desired, GoalContext& context);

  Simulation& simulation_;
  const std::string robot_;
  const int interfaces_;
  const std::vector<std::string> names_;
  const JointWay way_;
  const std::vector<Tolerance> path_, goal_;
  const double stamp_;
  double settling_ = 0, start_ = 0, posted_ = 0, timestep_ = 0;  // [s]
  Rational rate_ = {0, 1};
  std::vector<Joint> joints_;
  std::vector<double> from_;
  std::unique_ptr<ControlLease> lease_;
};

}  // namespace gloam::bridge
