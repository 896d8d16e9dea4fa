#pragma once
// Commands for the joints of a robot: targets of its controller, trajectories, another controller.

#include <cstdint>
#include <limits>
#include <vector>

#include "gloam/handle.h"
#include "gloam/joints/joint_trajectory.h"
#include "gloam/scene/robot.h"

namespace gloam {

/// Targets of one hinge or slide joint for its robot's controller. NaN = none: the controller's
/// own.
struct JointTarget {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double position = kNone;  ///< [rad, m]
  double velocity = kNone;  ///< [rad/s, m/s]
  double effort = kNone;    ///< feed-forward [N m, N]
  double kp = kNone;        ///< stiffness [N m/rad, N/m]
  double kd = kNone;        ///< damping [N m s/rad, N s/m]
};

/// Goal position of a hinge or slide joint for the robot's controller [rad, m]; stays until
/// changed. The same as a SetJointCommand with one position.
struct SetJointGoal {
  Joint joint;
  double position = 0;
};
/// Sets targets of a robot's joints, which stay until changed. Each vector has one value per joint,
/// where NaN removes the target, or is empty = unchanged. Joints that get a position or velocity
/// leave their trajectory, which the others continue to follow. docs/controllers.md lists the
/// targets that each controller uses.
struct SetJointCommand {
  Robot robot;
  std::vector<Joint> joints;  ///< empty = all hinges and slides of the robot, in the model's order
  std::vector<double> position = {}, velocity = {}, effort = {};  ///< as in JointTarget
  std::vector<double> kp = {}, kd = {};                           ///< >= 0 or NaN
};
/// Replaces the controller of a robot. The new one takes over from the present state; targets of
/// joints and the trajectory stay if its type is the same. It survives recompiles; a reset restores
/// the scene's.
struct SetController {
  Robot robot;
  ControllerOptions controller;
};
/// Makes the controller's targets follow a trajectory, evaluated at the controller's rate. It
/// replaces the trajectories of these joints, from whose present positions and velocities it
/// continues; joints without one start at their targets, or at their positions if they have none.
/// Other joints continue to follow theirs. It also replaces trajectories that were posted before it
/// for a later step and move one of these joints.
struct FollowTrajectory {
  Robot robot;
  std::vector<Joint> joints;  ///< as in SetJointCommand
  JointTrajectory trajectory;
  int64_t tag = 0;  ///< copied to ActiveTrajectory, where its sender recognizes it
};
/// Ends the trajectories of a robot's joints, which hold their present positions, and discards
/// trajectories that were posted earlier and have not started. Every client may post it, also while
/// another one has claimed the robot.
struct StopTrajectory {
  Robot robot;
  std::vector<Joint> joints = {};  ///< empty = all
};

}  // namespace gloam
