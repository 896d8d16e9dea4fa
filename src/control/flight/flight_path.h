#pragma once
// The motion that a quadrotor is to follow: a setpoint that moves along waypoints or with a
// velocity goal, within limits of speed and acceleration.

#include <Eigen/Dense>

#include "gloam/controller.h"

namespace gloam {

/// World frame.
struct FlightSetpoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< of the base's origin [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d a = Eigen::Vector3d::Zero();  ///< [m/s²]
  double yaw = 0, yaw_rate = 0;                 ///< [rad], [rad/s]
};

class FlightPath {
 public:
  explicit FlightPath(const FlightOptions& options) : options_(options) {}

  /// Holds at `p`. Waypoints start with the first.
  void reset(const Eigen::Vector3d& p, double yaw);
  /// Moves the setpoint by `dt` [s]. Waypoints are followed until the first velocity goal that is
  /// not zero; from then on the setpoint moves with the goal. `p`: position of the base [m].
  void update(const VelocityTarget& goal, const Eigen::Vector3d& p, double dt);

  /// Takes over the progress of the same vehicle's path, but not its waypoints.
  void continue_from(const FlightPath& before);

  const FlightSetpoint& setpoint() const { return setpoint_; }
  /// Waypoints that were reached.
  size_t reached() const { return next_; }

 private:
  void follow_velocity(const VelocityTarget& goal, const Eigen::Vector3d& p, double dt);
  void follow_waypoints(const Eigen::Vector3d& p, double dt);
  void change_velocity(const Eigen::Vector3d& wanted, double dt);
  void turn_to(double yaw, double dt);

  FlightOptions options_;
  FlightSetpoint setpoint_;
  size_t next_ = 0;
  double held_ = 0;  // time at the next waypoint [s]
  bool steered_ = false;
};

}  // namespace gloam
