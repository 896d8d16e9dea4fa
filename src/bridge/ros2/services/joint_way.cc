#include "bridge/ros2/services/joint_way.h"

#include <algorithm>
#include <utility>

#include "ros/trajectory_check.h"

namespace gloam::bridge {
namespace {

/// One end of a piece: its time, position and velocity.
struct End {
  double time, position, velocity;
};

// Cubic Hermite spline: position and velocity at `time`.
std::pair<double, double> on_cubic(const End& a, const End& b, double time) {
  const double T = b.time - a.time, s = (time - a.time) / T, d = b.position - a.position;
  const double c2 = 3 * d - T * (2 * a.velocity + b.velocity);
  const double c3 = -2 * d + T * (a.velocity + b.velocity);
  const double position = a.position + s * (T * a.velocity + s * (c2 + s * c3));
  return {position, a.velocity + s * (2 * c2 + 3 * s * c3) / T};
}

}  // namespace

Result<JointWay> JointWay::make(const trajectory_msgs::JointTrajectory& trajectory) {
  GLOAM_TRY_STATUS(check_points(trajectory));
  JointWay way;
  for (const auto& point : trajectory.points) {
    way.times_.push_back(point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec);
    way.positions_.push_back(point.positions);
    way.velocities_.push_back(point.velocities);
  }
  return way;
}

size_t JointWay::segment(double time) const {
  const auto next = std::ranges::lower_bound(times_, time);
  return std::min(static_cast<size_t>(next - times_.begin()), times_.size() - 1);
}

JointWayPoint JointWay::at(double time, const std::vector<double>& start) const {
  const size_t joints = start.size();
  JointWayPoint point;
  point.velocities.assign(joints, 0);
  if (time >= end()) {
    point.positions = positions_.back();
    return point;
  }
  const size_t i = segment(time);
  const bool is_first = i == 0;
  const double from_time = is_first ? 0 : times_[i - 1], to_time = times_[i];
  const std::vector<double>& from = is_first ? start : positions_[i - 1];
  const bool has_velocities = !velocities_[i].empty() && (is_first || !velocities_[i - 1].empty());
  for (size_t j = 0; j < joints; ++j) {
    const double to = positions_[i][j], T = to_time - from_time;
    if (T <= 0) {
      point.positions.push_back(to);
    } else if (has_velocities) {
      const End a{from_time, from[j], is_first ? 0 : velocities_[i - 1][j]};
      const auto [position, velocity] = on_cubic(a, {to_time, to, velocities_[i][j]}, time);
      point.positions.push_back(position);
      point.velocities[j] = velocity;
    } else {
      point.positions.push_back(from[j] + (to - from[j]) * (time - from_time) / T);
      point.velocities[j] = (to - from[j]) / T;
    }
  }
  return point;
}

}  // namespace gloam::bridge
