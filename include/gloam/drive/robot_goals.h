#pragma once
// Goals that the controllers of a robot accept, for programs that drive robots by hand.

#include <limits>
#include <optional>

#include "gloam/joints/ik.h"
#include "gloam/result.h"
#include "gloam/snapshot.h"
#include "gloam/world.h"

namespace gloam {

/// Velocities that a controller accepts along one axis; infinite = it has no limit of its own.
struct VelocityRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  static VelocityRange within(double most) { return {-most, most}; }
  bool is_zero() const { return low == 0 && high == 0; }  ///< the controller ignores the axis
};
/// Ranges of the components of a SetVelocityGoal, in its frame and units.
struct VelocityRanges {
  VelocityRange vx, vy, yaw_rate;
  VelocityRange vz = {0, 0};
};

/// A joint whose goal opens and closes all fingers of a gripper.
struct FingerGoal {
  Joint joint;
  double closed = 0, open = 0;  ///< its positions [rad, m]
  double opening = 1;           ///< of the fingers before the first goal: 0 = closed … 1 = open
};

/// Goals that a robot accepts, also by controllers of its parts.
struct RobotGoals {
  std::optional<VelocityRanges> velocity = {};  ///< SetVelocityGoal
  std::optional<ik::FrameName> frame = {};      ///< SetPoseGoal: the frame by its full name
  std::optional<FingerGoal> gripper = {};       ///< SetJointGoal of a gripper's finger
};

/// Goals for the controllers that the scene of a World selects. Errors: no such robot; as for the
/// creation of its controllers.
Result<RobotGoals> robot_goals(const World& world, Robot robot);

/// Pose X_WF of a frame at an instant. Error: no such frame, with the nearest name.
Result<Pose> frame_pose(const Instant& instant, const ik::FrameName& frame);

}  // namespace gloam
