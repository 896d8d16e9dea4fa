#pragma once
// JointWay: positions of joints over time, through the points of a trajectory.

#include <string>
#include <vector>

#include "gloam/result.h"
#include "ros/messages/trajectory_msgs.h"

namespace gloam::bridge {

/// Where joints are to be at an instant [rad, m], [rad/s, m/s].
struct JointWayPoint {
  std::vector<double> positions, velocities;
};

class JointWay {
 public:
  /// Errors: those of check_points().
  static Result<JointWay> make(const trajectory_msgs::JointTrajectory& trajectory);

  double end() const { return times_.back(); }  ///< [s]
  /// From `start`, where the joints are at time 0. Between two points that tell velocities a cubic,
  /// else a straight line; beyond the last point it stands.
  JointWayPoint at(double time, const std::vector<double>& start) const;
  /// Point that it is on the way to, from 0.
  size_t segment(double time) const;

 private:
  std::vector<double> times_;  // [s]
  std::vector<std::vector<double>> positions_, velocities_;
};

}  // namespace gloam::bridge
