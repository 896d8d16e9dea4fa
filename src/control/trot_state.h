#pragma once
// Measurements of the trot controller in each step: the robot's base, legs, feet and contacts.

#include <Eigen/Dense>
#include <array>
#include <span>

#include "control/trot_legs.h"
#include "instant/contact_load.h"

namespace gloam {

/// W = world, B = base body, H = heading frame (B's origin, x ahead, z up).
struct TrotState {
  Vector3d p_WB, v_W;  ///< of B's origin [m], [m/s]
  Matrix3d R_WB, R_WH;
  Vector3d omega_W;    ///< [rad/s]
  double yaw = 0;      ///< [rad], (-pi, pi]
  Vector3d gravity_B;  ///< [m/s²]
  Vector3d com_W;      ///< centre of mass of the whole robot [m]
  std::array<Vector3d, 4> q, qd;
  std::array<LegPose, 4> pose;  ///< in B
  std::array<Vector3d, 4> foot_W, foot_velocity_W;
  std::array<bool, 4> touching{};  ///< the foot is in contact with anything
};

/// Reads the state; contacts are those of the last step. No allocation.
void measure(const Quadruped& robot, const mjData& data, std::span<const ContactLoad> loads,
             TrotState& out);

/// Inertia of the whole robot about its centre of mass as it stands now, in B [kg m²].
Matrix3d composite_inertia(const Quadruped& robot, const TrotState& state);

}  // namespace gloam
