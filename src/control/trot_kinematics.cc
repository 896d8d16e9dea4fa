#include "control/trot_legs.h"

namespace gloam {

LegPose leg_pose(const Leg& leg, const Vector3d& q) {
  LegPose pose;
  Matrix3d R = Matrix3d::Identity();
  Vector3d t = Vector3d::Zero();  // x -> R x + t moves the reference configuration to this one
  for (int i = 0; i < 3; ++i) {
    pose.anchor[i] = R * leg.anchor_B[i] + t;
    pose.axis[i] = R * leg.axis_B[i];
    R = R * Eigen::AngleAxisd(q[i] - leg.q_ref[i], leg.axis_B[i]).toRotationMatrix();
    t = pose.anchor[i] - R * leg.anchor_B[i];
    pose.R[i] = R;
    pose.com[i] = R * leg.com_B[i] + t;
  }
  pose.foot = R * leg.foot_B + t;
  for (int i = 0; i < 3; ++i) pose.J.col(i) = pose.axis[i].cross(pose.foot - pose.anchor[i]);
  return pose;
}

Vector3d foot_bias_acceleration(const LegPose& pose, const Vector3d& qd) {
  Vector3d omega = Vector3d::Zero(), alpha = Vector3d::Zero(), a = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3d spin = pose.axis[i] * qd[i];
    alpha += omega.cross(spin);
    omega += spin;
    const Vector3d r = (i < 2 ? pose.anchor[i + 1] : pose.foot) - pose.anchor[i];
    a += alpha.cross(r) + omega.cross(omega.cross(r));
  }
  return a;
}

LegDynamics leg_dynamics(const Leg& leg, const LegPose& pose, const Vector3d& qd,
                         const Vector3d& qdd, const Vector3d& gravity_B) {
  std::array<Vector3d, 3> force, moment;  // on each link: rate of change of its momenta
  Vector3d omega = Vector3d::Zero(), alpha = Vector3d::Zero(), a = -gravity_B;
  for (int i = 0; i < 3; ++i) {
    const Vector3d spin = pose.axis[i] * qd[i];
    alpha += omega.cross(spin) + pose.axis[i] * qdd[i];
    omega += spin;
    const Vector3d r = pose.com[i] - pose.anchor[i];
    const Vector3d a_com = a + alpha.cross(r) + omega.cross(omega.cross(r));
    const Matrix3d inertia = pose.R[i] * leg.inertia_B[i] * pose.R[i].transpose();
    force[i] = leg.mass[i] * a_com;
    moment[i] = inertia * alpha + omega.cross(inertia * omega);
    if (i < 2) {
      const Vector3d next = pose.anchor[i + 1] - pose.anchor[i];
      a += alpha.cross(next) + omega.cross(omega.cross(next));
    }
  }
  LegDynamics out;
  out.force.setZero();
  out.moment.setZero();  // about B's origin, of link i and all after it
  for (int i = 2; i >= 0; --i) {
    out.force += force[i];
    out.moment += moment[i] + pose.com[i].cross(force[i]);
    const Vector3d about_anchor = out.moment - pose.anchor[i].cross(out.force);
    out.torque[i] = pose.axis[i].dot(about_anchor) + leg.armature[i] * qdd[i];
  }
  return out;
}

}  // namespace gloam
