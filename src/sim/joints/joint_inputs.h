#pragma once
// Targets of joints and trajectories that Commands have given to the robots of a simulation. Called
// on the sim thread only; allocates nothing but in take_over(). The cost of no function depends on
// the length of a trajectory, except for the binary search of the present point.

#include <mujoco/mujoco.h>

#include <memory>
#include <span>
#include <vector>

#include "gloam/joints/joint_command.h"
#include "sim/state/correspondence.h"
#include "world/world.h"

namespace gloam {

/// A trajectory that is about to start.
struct NextTrajectory {
  std::shared_ptr<ActiveTrajectory> trajectory;
  /// Gets the trajectories that its joints leave, whose memory is then released on another thread,
  /// (joints).
  std::vector<std::shared_ptr<ActiveTrajectory>> replaced;
};

class JointInputs {
 public:
  JointInputs(const CompiledWorld& world, const mjModel& model);

  /// Continues from those of another World, for the joints that remain. A trajectory that moves a
  /// removed joint ends; its other joints hold their targets.
  void take_over(const JointInputs& before, const Correspondence& same);
  void reset();
  /// Forgets the targets and ends the trajectories of a robot.
  void reset(int robot);

  void apply(const SetJointGoal& command);
  void apply(const SetJointCommand& command);
  /// Starts `next` before `step`.
  void follow(int robot, const mjModel& model, const mjData& data, int64_t step,
              NextTrajectory* next);
  void stop(const StopTrajectory& command, const mjModel& model, const mjData& data);
  /// Sets the targets of a robot from its trajectories at a time [s].
  void update(int robot, double time);

  std::span<const JointTarget> targets() const { return targets_; }
  /// The trajectory of a joint, also after its end; null = none.
  const std::shared_ptr<ActiveTrajectory>& trajectory(size_t joint) const {
    return followed_[joint].is_valid ? followed_[joint].trajectory : none_;
  }

 private:
  /// The trajectory that a joint follows.
  struct Followed {
    std::shared_ptr<ActiveTrajectory> trajectory;  // stays until replaced, so nothing is freed here
    size_t index = 0;                              // of the joint in it
    bool is_valid = false, is_over = false;

    bool is_moving() const { return is_valid && !is_over; }
    JointSample at(double time) const { return trajectory->at(time, index); }
  };
  const std::vector<Joint>& joints(int robot) const { return joints_[static_cast<size_t>(robot)]; }
  JointTarget& target(Joint joint) { return targets_[static_cast<size_t>(joint.id)]; }
  Followed& followed(Joint joint) { return followed_[static_cast<size_t>(joint.id)]; }
  JointSample start_of(Joint joint, const mjModel& model, const mjData& data);
  void leave_trajectory(Joint joint);

  std::vector<JointTarget> targets_;        // by joint
  std::vector<Followed> followed_;          // by joint
  std::vector<std::vector<Joint>> joints_;  // hinges and slides, by robot
  std::vector<JointSample> start_;          // of follow(), (most joints of a robot)
  std::shared_ptr<ActiveTrajectory> none_;
};

/// Joints of a Command, those of the robot where it names none; the model's order.
std::vector<Joint> joints_of_command(const CompiledWorld& world, Robot robot,
                                     const std::vector<Joint>& named);

}  // namespace gloam
