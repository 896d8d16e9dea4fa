#pragma once
// Path of a swinging foot: smooth from lift-off to the foothold, which may move meanwhile.

#include <Eigen/Dense>

namespace gloam {

struct FootGoal {
  Eigen::Vector3d p, v, a;  ///< of the foot's centre, world axes [m], [m/s], [m/s²]
};

/// Point at `phase` (0 … 1) of a swing that lasts `duration` [s]: horizontally a minimum-jerk path,
/// vertically up to `clearance` above the higher end and down again, at rest at both ends.
FootGoal swing_point(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double clearance,
                     double phase, double duration);

}  // namespace gloam
