#include "control/flight/flight_path.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

using Eigen::Vector3d;

constexpr double kLeash = 2;  // largest distance of a steered setpoint from the vehicle [m]
constexpr double kSettledSpeed = 0.5;  // of the setpoint at a waypoint, in accelerations x period

Vector3d within(const Vector3d& v, double most) {
  const double norm = v.norm();
  return norm > most ? Vector3d(v * (most / norm)) : v;
}

}  // namespace

void FlightPath::reset(const Vector3d& p, double yaw) {
  setpoint_ = {};
  setpoint_.p = p;
  setpoint_.yaw = yaw;
  next_ = 0;
  held_ = 0;
  steered_ = false;
}

void FlightPath::continue_from(const FlightPath& before) {
  setpoint_ = before.setpoint_;
  next_ = before.next_;
  held_ = before.held_;
  steered_ = before.steered_;
}

void FlightPath::update(const VelocityTarget& goal, const Vector3d& p, double dt) {
  const bool moving = goal.vx != 0 || goal.vy != 0 || goal.vz != 0 || goal.yaw_rate != 0;
  steered_ = steered_ || moving;
  setpoint_.yaw_rate = 0;
  if (steered_) {
    follow_velocity(goal, p, dt);
  } else {
    follow_waypoints(p, dt);
  }
}

void FlightPath::change_velocity(const Vector3d& wanted, double dt) {
  const Vector3d change = within(wanted - setpoint_.v, options_.max_acceleration * dt);
  setpoint_.v += change;
  setpoint_.a = change / dt;
}

void FlightPath::follow_velocity(const VelocityTarget& goal, const Vector3d& p, double dt) {
  const double c = std::cos(setpoint_.yaw), s = std::sin(setpoint_.yaw);
  Vector3d wanted(c * goal.vx - s * goal.vy, s * goal.vx + c * goal.vy, 0);
  wanted = within(wanted, options_.max_speed);
  wanted.z() = std::clamp(goal.vz, -options_.max_climb, options_.max_climb);
  change_velocity(wanted, dt);
  // A vehicle that is blocked must not find its setpoint far away when it is free again.
  setpoint_.p = p + within(setpoint_.p + setpoint_.v * dt - p, kLeash);
  setpoint_.yaw_rate = std::clamp(goal.yaw_rate, -options_.max_yaw_rate, options_.max_yaw_rate);
  setpoint_.yaw = std::remainder(setpoint_.yaw + setpoint_.yaw_rate * dt, 2 * M_PI);
}

void FlightPath::follow_waypoints(const Vector3d& p, double dt) {
  if (next_ >= options_.waypoints.size()) {
    change_velocity(Vector3d::Zero(), dt);
    setpoint_.p += setpoint_.v * dt;
    return;
  }
  const Waypoint& waypoint = options_.waypoints[next_];
  const Vector3d target(waypoint.position.x, waypoint.position.y, waypoint.position.z);
  const Vector3d way = target - setpoint_.p;
  const double distance = way.norm();
  const double step_speed = options_.max_acceleration * dt;
  if (distance <= step_speed * dt &&
      setpoint_.v.norm() <= kSettledSpeed * step_speed + step_speed) {
    setpoint_.p = target;
    setpoint_.v = setpoint_.a = Vector3d::Zero();
  } else {
    // The fastest approach that can still stop at the waypoint; half a step early, since the speed
    // is held over a step.
    double speed = std::min(waypoint.speed.value_or(options_.max_speed), options_.max_speed);
    const double climb = std::abs(way.z()) / distance;
    if (climb * speed > options_.max_climb) speed = options_.max_climb / climb;
    const double stopping =
        std::sqrt(2 * options_.max_acceleration * distance + 0.25 * step_speed * step_speed) -
        0.5 * step_speed;
    speed = std::min({speed, stopping, distance / dt});
    change_velocity(way * (speed / distance), dt);
    setpoint_.p += setpoint_.v * dt;
  }
  if (waypoint.yaw) turn_to(*waypoint.yaw, dt);

  const bool arrived = setpoint_.p == target && (p - target).norm() <= options_.tolerance;
  held_ = arrived ? held_ + dt : 0;
  if (arrived && held_ >= waypoint.hold) {
    ++next_;
    held_ = 0;
  }
}

void FlightPath::turn_to(double yaw, double dt) {
  const double most = options_.max_yaw_rate;
  const double turn = std::remainder(yaw - setpoint_.yaw, 2 * M_PI);
  setpoint_.yaw_rate = std::clamp(turn / dt, -most, most);
  setpoint_.yaw = std::remainder(setpoint_.yaw + setpoint_.yaw_rate * dt, 2 * M_PI);
}

}  // namespace gloam
