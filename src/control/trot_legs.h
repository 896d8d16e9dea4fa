#pragma once
// The legs of a 12-joint quadruped, discovered in any mjModel: four chains of three hinges below a
// floating base, each ending in a foot. Kinematics and dynamics are our own (products of
// exponentials and recursive Newton-Euler over three links), so that a control step costs the same
// however large the world is.

#include <Eigen/Dense>
#include <array>

#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One leg. Geometry is in the base frame B with the joints at `q_ref`.
struct Leg {
  std::array<int, 3> qpos{}, dof{}, actuator{};  ///< addresses in mjData; hip, thigh, calf
  std::array<double, 3> torque_limit{};          ///< at the joint [N m]
  std::array<double, 3> torque_per_control{};    ///< gear times gain
  std::array<double, 3> armature{}, damping{}, friction{};
  std::array<double, 3> q_ref{};
  std::array<Vector3d, 3> axis_B, anchor_B;
  std::array<double, 3> mass{};  ///< of what moves with the joint and not with the next [kg]
  std::array<Vector3d, 3> com_B;
  std::array<Matrix3d, 3> inertia_B;  ///< about com_B [kg m²]
  Vector3d foot_B;                    ///< centre of the foot
  double foot_radius = 0;             ///< [m]
  int foot_geom = -1;
  double length = 0;  ///< thigh axis to calf axis to foot [m]
};

/// A quadruped: its base and its legs, in the order front left, front right, rear left, rear right.
struct Quadruped {
  int base_body = -1, base_qpos = -1, base_dof = -1;
  std::array<Leg, 4> legs;
  double base_mass = 0;
  Vector3d base_com_B;
  Matrix3d base_inertia_B;  ///< of the base without legs, about base_com_B
  double mass = 0;          ///< of the whole robot [kg]
  double gravity = 9.81;    ///< magnitude [m/s²]
  double leg_length = 0;    ///< mean [m]
};

/// Reads a quadruped out of a model. Errors say what is missing (legs, feet, torque motors).
Result<Quadruped> find_quadruped(const mjModel& model, const RobotInstance& robot);

/// Pose of one leg, in B.
struct LegPose {
  std::array<Vector3d, 3> axis, anchor, com;
  std::array<Matrix3d, 3> R;  ///< link rotation from the reference
  Vector3d foot;
  Matrix3d J;  ///< d foot / d q
};
LegPose leg_pose(const Leg& leg, const Vector3d& q);

/// Acceleration of the foot that joint velocities alone cause, J-dot qdot, in B with B at rest.
Vector3d foot_bias_acceleration(const LegPose& pose, const Vector3d& qd);

/// Terms of a leg's dynamics.
struct LegDynamics {
  Vector3d torque;  ///< of the joints [N m], armature included
  Vector3d force;   ///< total of the links' mass times acceleration [N], in B
  Vector3d moment;  ///< of the same about B's origin, with rotation [N m], in B
};
/// Inverse dynamics with B accelerating at -gravity_B and not turning.
LegDynamics leg_dynamics(const Leg& leg, const LegPose& pose, const Vector3d& qd,
                         const Vector3d& qdd, const Vector3d& gravity_B);

}  // namespace gloam
