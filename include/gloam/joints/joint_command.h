#pragma once
// Commands for the joints of a robot: targets of its controller, trajectories, another controller.

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
/// leave the trajectory of their robot, which ends. docs/controllers.md lists the targets that each
/// controller uses.
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
/// Makes the controller's targets follow a trajectory, evaluated at the controller's rate. Replaces
/// the robot's previous trajectory, from whose present position and velocity it continues;
/// otherwise it starts at the joints' targets, or at their positions if they have none.
struct FollowTrajectory {
  Robot robot;
  std::vector<Joint> joints;  ///< as in SetJointCommand
  JointTrajectory trajectory;
};
/// Ends the robot's trajectory; its joints hold their present positions.
struct StopTrajectory {
  Robot robot;
};

}  // namespace gloam
