#pragma once
// The cascade of a quadrotor: position -> velocity -> attitude -> angular velocity -> wrench. The
// structure is that of PX4's multicopter controller; the attitude error is that of Brescianini,
// Hehn, D'Andrea 2013, "Nonlinear Quadrocopter Attitude Control".

#include <Eigen/Dense>

#include "control/flight/flight_path.h"
#include "control/flight/mixer.h"

namespace gloam {

/// Motion of the base. W = world, B = base body.
struct FlightState {
  Eigen::Vector3d p_WB, v_W;  ///< [m], [m/s]
  Eigen::Quaterniond q_WB;
  Eigen::Vector3d omega_B;  ///< [rad/s]
};

class FlightCascade {
 public:
  /// `gravity`: magnitude [m/s²].
  FlightCascade(const FlightOptions& options, const Multirotor& vehicle, double gravity);

  void reset();
  /// Takes over the integrals of the same vehicle's cascade.
  void continue_from(const FlightCascade& before);
  /// `saturated`: the mixer reduced the last wrench, so integrals must not grow.
  FlightWrench update(const FlightState& state, const FlightSetpoint& setpoint, double dt,
                      bool saturated);

 private:
  Eigen::Vector3d specific_force(const FlightState& state, const FlightSetpoint& setpoint,
                                 double dt, bool saturated);
  Eigen::Vector3d torque(const FlightState& state, const Eigen::Vector3d& omega_wanted_B, double dt,
                         bool saturated);

  FlightOptions options_;
  double mass_, gravity_;
  Eigen::Matrix3d inertia_B_;
  Eigen::Vector3d velocity_integral_, rate_integral_;  // [m/s²], [rad/s²]
  Eigen::Vector3d last_velocity_error_, last_rate_error_;
  bool started_ = false;
};

}  // namespace gloam
