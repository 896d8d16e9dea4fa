#include "control/trot_state.h"

#include <cmath>

namespace gloam {

void measure(const Quadruped& robot, const mjData& d, std::span<const ContactLoad> loads,
             TrotState& out) {
  const mjtNum* qpos = d.qpos + robot.base_qpos;
  const mjtNum* qvel = d.qvel + robot.base_dof;
  out.p_WB = {qpos[0], qpos[1], qpos[2]};
  out.R_WB = Eigen::Quaterniond(qpos[3], qpos[4], qpos[5], qpos[6]).normalized().toRotationMatrix();
  out.v_W = {qvel[0], qvel[1], qvel[2]};
  out.omega_W = out.R_WB * Vector3d(qvel[3], qvel[4], qvel[5]);  // MuJoCo keeps it in B
  out.yaw = std::atan2(out.R_WB(1, 0), out.R_WB(0, 0));
  out.R_WH = Eigen::AngleAxisd(out.yaw, Vector3d::UnitZ()).toRotationMatrix();
  out.gravity_B = out.R_WB.transpose() * Vector3d(0, 0, -robot.gravity);

  Vector3d com_B = robot.base_mass * robot.base_com_B;
  for (int k = 0; k < 4; ++k) {
    const Leg& leg = robot.legs[k];
    for (int i = 0; i < 3; ++i) {
      out.q[k][i] = d.qpos[leg.qpos[i]];
      out.qd[k][i] = d.qvel[leg.dof[i]];
    }
    out.pose[k] = leg_pose(leg, out.q[k]);
    for (int i = 0; i < 3; ++i) com_B += leg.mass[i] * out.pose[k].com[i];
    const Vector3d arm = out.R_WB * out.pose[k].foot;
    out.foot_W[k] = out.p_WB + arm;
    out.foot_velocity_W[k] =
        out.v_W + out.omega_W.cross(arm) + out.R_WB * (out.pose[k].J * out.qd[k]);
  }
  out.com_W = out.p_WB + out.R_WB * (com_B / robot.mass);

  out.touching.fill(false);
  for (int c = 0; c < d.ncon; ++c) {
    if (d.contact[c].efc_address < 0) continue;
    for (int k = 0; k < 4; ++k)
      if (d.contact[c].geom[0] == robot.legs[k].foot_geom ||
          d.contact[c].geom[1] == robot.legs[k].foot_geom)
        out.touching[k] = true;
  }
  for (const ContactLoad& load : loads) {
    for (int k = 0; k < 4; ++k)
      if (load.geom == robot.legs[k].foot_geom) out.touching[k] = true;
  }
}

Matrix3d composite_inertia(const Quadruped& robot, const TrotState& state) {
  const Vector3d center = state.R_WB.transpose() * (state.com_W - state.p_WB);
  const auto moved = [&](double mass, const Vector3d& com) -> Matrix3d {
    const Vector3d r = com - center;
    return mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  };
  Matrix3d total = robot.base_inertia_B + moved(robot.base_mass, robot.base_com_B);
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 3; ++i) {
      const Matrix3d& R = state.pose[k].R[i];
      total += R * robot.legs[k].inertia_B[i] * R.transpose() +
               moved(robot.legs[k].mass[i], state.pose[k].com[i]);
    }
  return total;
}

}  // namespace gloam
