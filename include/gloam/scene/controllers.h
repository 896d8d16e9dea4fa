#pragma once
// Settings of controllers of [robot.controller] that have a table of their own. Part of
// gloam/scene/robot.h.

#include <optional>
#include <string>
#include <vector>

#include "gloam/types.h"

namespace gloam {

/// A point at which a quadrotor stops on its way.
struct Waypoint {
  Vec3 position = {};                ///< of the base's origin, world frame [m]
  std::optional<double> yaw = {};    ///< heading there [rad], 0 = +X; empty = unchanged
  std::optional<double> speed = {};  ///< on the way to it [m/s]; empty = max_speed
  double hold = 0;                   ///< time to stay there [s]
  SourceLoc loc = {};
};

/// [robot.controller.flight]: the cascade of the controller "quadrotor". All gains are per unit of
/// mass or inertia, so they do not depend on the size of the vehicle.
struct FlightOptions {
  std::vector<Waypoint> waypoints = {};  ///< in order; empty = hover where the run starts
  double max_speed = 5;                  ///< [m/s]
  double max_climb = 2;                  ///< vertical speed [m/s]
  double max_acceleration = 2.5;         ///< of the setpoint [m/s²]
  double max_tilt = 0.7;                 ///< [rad], below pi/2
  double max_yaw_rate = 1.5;             ///< [rad/s]
  double tolerance = 0.2;                ///< distance at which a waypoint is reached [m]
  double position_gain = 1.5;            ///< speed per position error [1/s]
  Vec3 velocity_gains = {5, 2, 0};       ///< PID: acceleration per velocity error [1/s, 1/s², 1]
  double attitude_gain = 10;             ///< angular velocity per attitude error [1/s]
  Vec3 rate_gains = {25, 20, 0};  ///< PID: angular acceleration per rate error [1/s, 1/s², 1]
};

/// [robot.controller.drive]: the base of the controller "diff_drive".
struct DriveOptions {
  /// Joints of the wheels, without the robot's prefix; both empty = all driven wheels whose axes
  /// are parallel to the base's y axis, by the side on which they are.
  std::vector<std::string> left = {}, right = {};
  double wheel_radius = 0;      ///< [m]; 0 = from the wheels' geoms
  double track = 0;             ///< distance between left and right wheels [m]; 0 = from the model
  double max_speed = 1;         ///< [m/s]
  double max_yaw_rate = 2;      ///< [rad/s]
  double max_acceleration = 1;  ///< [m/s²]
  double max_yaw_acceleration = 4;  ///< [rad/s²]
};

/// [robot.controller.grip]: the fingers of the controller "gripper".
struct GripOptions {
  double force = 20;      ///< largest force or torque of each finger's joint [N or N m]
  double speed = 0.1;     ///< at which fingers open and close [m/s or rad/s]
  double opening = 1;     ///< until a Command changes it: 0 = closed … 1 = open
  bool inverted = false;  ///< the joints' upper limits are the closed position
};

}  // namespace gloam
