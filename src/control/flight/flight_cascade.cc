#include "control/flight/flight_cascade.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kLeastLift = 0.2;                // vertical specific force over gravity
constexpr double kLargestVelocityIntegral = 0.7;  // over gravity: a steady wind at a tilt of 35 deg
constexpr double kLargestRateIntegral = 20;       // [rad/s²]
constexpr double kLargestRate = 6;                // wanted roll and pitch rates [rad/s]

// Attitude whose z axis is along `force` and whose heading is `yaw`.
Quaterniond attitude_along(const Vector3d& force, double yaw) {
  const Vector3d z = force.normalized();
  const Vector3d heading(std::cos(yaw), std::sin(yaw), 0);
  const Vector3d y = z.cross(heading).normalized();
  Matrix3d R;
  R << y.cross(z), y, z;
  return Quaterniond(R);
}

Vector3d limited(const Vector3d& v, double most) {
  return v.cwiseMax(Vector3d::Constant(-most)).cwiseMin(Vector3d::Constant(most));
}

}  // namespace

FlightCascade::FlightCascade(const FlightOptions& options, const Multirotor& vehicle,
                             double gravity)
    : options_(options), mass_(vehicle.mass), gravity_(gravity), inertia_B_(vehicle.inertia_B) {
  reset();
}

void FlightCascade::reset() {
  velocity_integral_ = rate_integral_ = Vector3d::Zero();
  last_velocity_error_ = last_rate_error_ = Vector3d::Zero();
  started_ = false;
}

void FlightCascade::continue_from(const FlightCascade& before) {
  velocity_integral_ = before.velocity_integral_;
  rate_integral_ = before.rate_integral_;
  last_velocity_error_ = before.last_velocity_error_;
  last_rate_error_ = before.last_rate_error_;
  started_ = before.started_;
}

FlightWrench FlightCascade::update(const FlightState& state, const FlightSetpoint& setpoint,
                                   double dt, bool saturated) {
  const Vector3d force_W = specific_force(state, setpoint, dt, saturated);
  const Matrix3d R_WB = state.q_WB.toRotationMatrix();
  FlightWrench wrench;
  wrench.thrust = mass_ * std::max(0.0, force_W.dot(R_WB.col(2)));

  // The shorter of the two rotations to the wanted attitude; its error grows up to 180 degrees.
  const Quaterniond error = state.q_WB.conjugate() * attitude_along(force_W, setpoint.yaw);
  const Vector3d turn = (error.w() < 0 ? -2.0 : 2.0) * error.vec();
  Vector3d omega_B = limited(options_.attitude_gain * turn, kLargestRate);
  omega_B += R_WB.transpose() * Vector3d(0, 0, setpoint.yaw_rate);
  wrench.torque = torque(state, omega_B, dt, saturated);
  started_ = true;
  return wrench;
}

// Wanted acceleration minus gravity, within the limit of tilt [m/s²], world frame.
Vector3d FlightCascade::specific_force(const FlightState& state, const FlightSetpoint& setpoint,
                                       double dt, bool saturated) {
  const Vec3& gains = options_.velocity_gains;
  Vector3d wanted = setpoint.v + options_.position_gain * (setpoint.p - state.p_WB);
  const double horizontal = wanted.head<2>().norm();
  if (horizontal > options_.max_speed) wanted.head<2>() *= options_.max_speed / horizontal;
  wanted.z() = std::clamp(wanted.z(), -options_.max_climb, options_.max_climb);
  const Vector3d error = wanted - state.v_W;
  const Vector3d change =
      started_ ? Vector3d((error - last_velocity_error_) / dt) : Vector3d::Zero();
  last_velocity_error_ = error;

  Vector3d force = setpoint.a + gains.x * error + velocity_integral_ + gains.z * change;
  force.z() = std::max(force.z() + gravity_, kLeastLift * gravity_);
  const double sideways = force.head<2>().norm();
  const double most = std::tan(options_.max_tilt) * force.z();
  const bool tilted = sideways > most;
  if (tilted) force.head<2>() *= most / sideways;
  if (!tilted && !saturated) {
    velocity_integral_ =
        limited(velocity_integral_ + gains.y * dt * error, kLargestVelocityIntegral * gravity_);
  }
  return force;
}

Vector3d FlightCascade::torque(const FlightState& state, const Vector3d& omega_wanted_B, double dt,
                               bool saturated) {
  const Vec3& gains = options_.rate_gains;
  const Vector3d error = omega_wanted_B - state.omega_B;
  const Vector3d change = started_ ? Vector3d((error - last_rate_error_) / dt) : Vector3d::Zero();
  last_rate_error_ = error;
  if (!saturated)
    rate_integral_ = limited(rate_integral_ + gains.y * dt * error, kLargestRateIntegral);
  const Vector3d acceleration = gains.x * error + rate_integral_ + gains.z * change;
  return inertia_B_ * acceleration + state.omega_B.cross(inertia_B_ * state.omega_B);
}

}  // namespace gloam
