#pragma once
// From the velocity somebody asks for to the motion the body is meant to make now.

#include "control/trot_options.h"
#include "control/trot_state.h"
#include "gloam/controller.h"

namespace gloam {

/// The motion wanted of the base's origin at this instant.
struct BodyGoal {
  VelocityTarget velocity;          ///< what was asked for, acceleration-limited; heading frame
  Vector3d p_W = Vector3d::Zero();  ///< world axes [m]; z is unused
  Vector3d v_W = Vector3d::Zero();  ///< [m/s]
  Vector3d a_W = Vector3d::Zero();  ///< [m/s²]
  double yaw = 0;                   ///< [rad]
  double height = 0;                ///< above the centres of the standing feet [m]
};

/// Limits the goal's acceleration and moves a goal pose along with it. The pose leads the body on a
/// short leash, which makes it the integral action that removes steady velocity errors.
class GoalShaper {
 public:
  /// `standing_height`: of the base's origin above the foot centres [m].
  GoalShaper(const TrotOptions& options, double standing_height)
      : options_(options), standing_height_(standing_height) {}

  /// Starts at rest where the robot is, `height` above its foot centres.
  void reset(const TrotState& state, double height);
  void update(const VelocityTarget& target, const TrotState& state, double dt);
  /// Stay here: the goal pose becomes the present one.
  void hold(const TrotState& state);

  bool moving() const;
  const BodyGoal& goal() const { return goal_; }

 private:
  TrotOptions options_;
  double standing_height_;
  BodyGoal goal_;
};

}  // namespace gloam
