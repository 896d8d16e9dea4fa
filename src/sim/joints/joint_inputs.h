#pragma once
// Targets of joints and trajectories that Commands have given to the robots of a simulation. Called
// on the sim thread only; allocates nothing but in take_over().

#include <mujoco/mujoco.h>

#include <memory>
#include <span>
#include <vector>

#include "gloam/joints/joint_command.h"
#include "sim/state/correspondence.h"
#include "world/world.h"

namespace gloam {

class JointInputs {
 public:
  JointInputs(const CompiledWorld& world, const mjModel& model);

  /// Continues from those of another World, for the joints that remain. A trajectory that moves a
  /// removed joint ends.
  void take_over(const JointInputs& before, const Correspondence& same);
  void reset();
  /// Forgets the targets and ends the trajectory of a robot.
  void reset(int robot);

  void apply(const SetJointGoal& command);
  void apply(const SetJointCommand& command);
  /// Starts `next` before `step`. `next` gets the trajectory that it replaces, whose memory is then
  /// released on another thread.
  void follow(int robot, const mjModel& model, const mjData& data, int64_t step,
              std::shared_ptr<ActiveTrajectory>* next);
  void stop(int robot, const mjModel& model, const mjData& data);
  /// Sets the targets of a robot from its trajectory at a time [s].
  void update(int robot, double time);

  std::span<const JointTarget> targets() const { return targets_; }
  /// The trajectory of a robot, also after its end; null = none.
  const std::shared_ptr<ActiveTrajectory>& trajectory(int robot) const {
    return of(robot).is_valid ? of(robot).trajectory : none_;
  }

 private:
  struct RobotInputs {
    std::vector<Joint> joints;                     // hinges and slides
    std::shared_ptr<ActiveTrajectory> trajectory;  // stays until replaced, so nothing is freed here
    bool is_valid = false, is_over = false;
  };
  RobotInputs& of(int robot) { return robots_[static_cast<size_t>(robot)]; }
  const RobotInputs& of(int robot) const { return robots_[static_cast<size_t>(robot)]; }
  JointTarget& target(Joint joint) { return targets_[static_cast<size_t>(joint.id)]; }
  void leave_trajectory(RobotInputs* robot, Joint joint);

  std::vector<JointTarget> targets_;  // by joint
  std::vector<RobotInputs> robots_;
  std::vector<int> robot_of_joint_;  // -1 = none
  std::vector<JointSample> start_;   // of follow(), (most joints of a robot)
  std::shared_ptr<ActiveTrajectory> none_;
};

/// Joints of a Command, those of the robot where it names none; the model's order.
std::vector<Joint> joints_of_command(const CompiledWorld& world, Robot robot,
                                     const std::vector<Joint>& named);

}  // namespace gloam
