#pragma once
// Every tunable number of the trot controller, with its unit. Lengths and times are given for a leg
// of kReferenceLeg and scaled to the robot by dynamic similarity: lengths with L, times with
// sqrt(L).

namespace gloam {

/// Thigh plus calf of the robot the defaults were tuned on [m].
inline constexpr double kReferenceLeg = 0.426;

struct TrotOptions {
  // Gait.
  double period = 0.38;     ///< of one stride [s]
  double duty = 0.61;       ///< fraction of the stride a foot is on the ground, 0.5 … 0.8
  double clearance = 0.06;  ///< height of the swinging foot's lowest point above ground [m]
  double crouch = 0.65;     ///< hip height over foot centre / leg length when standing
  double press = 0.006;  ///< how far below the ground a foothold is aimed, so that it touches [m]
  double reach_speed = 0.4;  ///< a foot that misses the ground goes on down at this speed [m/s]

  // Foot placement (Raibert 1986): nominal + v T/2 + k (v - v_goal).
  double placement_gain = 0.08;   ///< k [s]
  double placement_limit = 0.18;  ///< largest distance from the nominal foothold [m]

  // Goal shaping.
  double linear_acceleration = 3.0;   ///< of the goal [m/s²]
  double angular_acceleration = 8.0;  ///< of the goal [rad/s²]

  // Body: wanted acceleration = kp error + kd error rate.
  double kp_xy = 12, kd_xy = 22;       ///< [1/s²], [1/s]
  double kp_z = 120, kd_z = 20;        ///< [1/s²], [1/s]
  double kp_tilt = 180, kd_tilt = 22;  ///< roll and pitch [1/s²], [1/s]
  double kp_yaw = 40, kd_yaw = 12;     ///< [1/s²], [1/s]
  double position_leash = 0.06;        ///< largest position error that is fed back [m]
  double yaw_leash = 0.25;             ///< largest heading error that is fed back [rad]
  double height_integral = 40;         ///< removes the sag under a payload [1/s³]
  double height_integral_limit = 4;    ///< [m/s²]

  // Force distribution: weights of the wrench error in N and N m, and of the forces themselves.
  double weight_xy = 1.5, weight_z = 2, weight_tilt = 30, weight_yaw = 20;
  double weight_force = 1e-3, weight_change = 2e-3;
  double friction = 0.35;  ///< friction coefficient that the forces keep within
  int sweeps = 40;         ///< of the force solver

  // Swing: foot acceleration = path + kp error + kd error rate.
  double kp_swing = 1400, kd_swing = 60;  ///< [1/s²], [1/s]

  // Standing.
  double wake_speed = 0.12;  ///< a standing robot steps when pushed faster than this [m/s]
};

}  // namespace gloam
