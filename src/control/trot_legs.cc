#include "control/trot_legs.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "control/trot_names.h"
#include "world/model_memory.h"
#include "world/world.h"

namespace gloam {
namespace {

Vector3d vec(const mjtNum* p) { return {p[0], p[1], p[2]}; }
Matrix3d mat(const mjtNum* p) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(p);
}

std::string name_of(const mjModel& m, mjtObj type, int id) {
  const char* name = mj_id2name(&m, type, id);
  return name != nullptr && *name != 0 ? name : "#" + std::to_string(id);
}

bool is_below(const mjModel& m, int body, int ancestor) {
  while (body > ancestor) body = m.body_parentid[body];
  return body == ancestor;
}

/// Mass, centre and inertia of everything rigidly joined to `weld` (mjModel::body_weldid), in B.
struct Rigid {
  double mass = 0;
  Vector3d com = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();
};
Rigid rigid_of(const mjModel& m, const mjData& d, int weld, const Matrix3d& R_WB,
               const Vector3d& p_WB) {
  Rigid out;
  const auto com_of = [&](int b) -> Vector3d {
    return R_WB.transpose() * (vec(d.xipos + 3 * b) - p_WB);
  };
  for (int b = weld; b < m.nbody; ++b) {
    if (m.body_weldid[b] != weld) continue;
    out.mass += m.body_mass[b];
    out.com += m.body_mass[b] * com_of(b);
  }
  if (out.mass > 0) out.com /= out.mass;
  for (int b = weld; b < m.nbody; ++b) {
    if (m.body_weldid[b] != weld) continue;
    const Matrix3d R = R_WB.transpose() * mat(d.ximat + 9 * b);
    const Vector3d r = com_of(b) - out.com;
    out.inertia += R * vec(m.body_inertia + 3 * b).asDiagonal() * R.transpose() +
                   m.body_mass[b] * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  }
  return out;
}

Status find_motor(const mjModel& m, int joint, int i, Leg& leg) {
  const std::string joint_name = name_of(m, mjOBJ_JOINT, joint);
  for (int a = 0; a < m.nu; ++a) {
    if (m.actuator_trntype[a] != mjTRN_JOINT || m.actuator_trnid[2 * a] != joint) continue;
    if (m.actuator_gaintype[a] != mjGAIN_FIXED || m.actuator_biastype[a] != mjBIAS_NONE ||
        m.actuator_dyntype[a] != mjDYN_NONE)
      return Error{.kind = ErrorKind::kUnsupported,
                   .message = "actuator '" + name_of(m, mjOBJ_ACTUATOR, a) +
                              "' is not a torque motor, which the trot controller requires",
                   .hint = "use <motor joint=\"" + joint_name + "\" ctrlrange=\"…\"/>"};
    const double gain = m.actuator_gainprm[mjNGAIN * a] * m.actuator_gear[6 * a];
    if (gain == 0)
      return Error{.message = "actuator '" + name_of(m, mjOBJ_ACTUATOR, a) + "' has no gain"};
    double limit = 1e6;
    const auto limit_by = [&](const mjtNum* range, double scale) {
      limit = std::min(limit, std::min(std::abs(range[0]), std::abs(range[1])) * std::abs(scale));
    };
    if (m.actuator_ctrllimited[a]) limit_by(m.actuator_ctrlrange + 2 * a, gain);
    if (m.actuator_forcelimited[a]) limit_by(m.actuator_forcerange + 2 * a, m.actuator_gear[6 * a]);
    if (m.jnt_actfrclimited[joint]) limit_by(m.jnt_actfrcrange + 2 * joint, 1);
    leg.actuator[i] = a;
    leg.torque_per_control[i] = gain;
    leg.torque_limit[i] = limit;
    return {};
  }
  return Error{.kind = ErrorKind::kUnsupported,
               .message = "joint '" + joint_name +
                          "' has no actuator; the trot controller needs a "
                          "torque motor on each of 12 joints",
               .hint = "add <motor joint=\"" + joint_name + "\" ctrlrange=\"…\"/>"};
}

/// Pose of the base in the world.
struct BasePose {
  Matrix3d R_WB;
  Vector3d p_WB;
  Vector3d in_base(const Vector3d& p_W) const { return R_WB.transpose() * (p_W - p_WB); }
};

/// The foot: of the last link's collision geoms, the one that reaches farthest from the calf axis;
/// of those that are `named`, if any.
Status find_foot(const mjModel& m, const mjData& d, int calf_body, const BasePose& X_WB,
                 const NamedFoot& named, Leg& leg) {
  double best = -1;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.body_weldid[m.geom_bodyid[g]] != m.body_weldid[calf_body]) continue;
    if (named.geom >= 0 && g != named.geom) continue;
    if (named.body >= 0 && m.geom_bodyid[g] != named.body) continue;
    if (m.geom_contype[g] == 0 && m.geom_conaffinity[g] == 0) continue;
    const Vector3d center = vec(d.geom_xpos + 3 * g);
    const Vector3d along = mat(d.geom_xmat + 9 * g).col(2);
    double radius = m.geom_rbound[g], half = 0;
    if (m.geom_type[g] == mjGEOM_SPHERE) radius = m.geom_size[3 * g];
    if (m.geom_type[g] == mjGEOM_CAPSULE) {
      radius = m.geom_size[3 * g];
      half = m.geom_size[3 * g + 1];
    }
    for (const double end : {-half, half}) {
      const Vector3d p_B = X_WB.in_base(center + end * along);
      const double distance = (p_B - leg.anchor_B[2]).norm() +
                              (m.geom_type[g] == mjGEOM_SPHERE ? radius : 0.5 * radius);
      if (distance <= best) continue;
      best = distance;
      leg.foot_geom = g;
      leg.foot_B = p_B;
      leg.foot_radius = radius;
    }
  }
  if (best < 0)
    return Error{.kind = ErrorKind::kUnsupported,
                 .message = "body '" + name_of(m, mjOBJ_BODY, calf_body) +
                            "' has no collision geom to stand on",
                 .hint = "add a sphere at the end of each leg"};
  if (named.site >= 0) {
    leg.foot_B = X_WB.in_base(vec(d.site_xpos + 3 * named.site));
    leg.foot_radius = m.site_size[3 * named.site];
  }
  return {};
}

/// Chains of three hinges below the base: the last has exactly two between it and the base, and
/// none below it.
std::vector<std::array<int, 3>> find_chains(const mjModel& m, int base_body) {
  std::vector<std::array<int, 3>> chains;
  for (int j = 0; j < m.njnt; ++j) {
    const int body = m.jnt_bodyid[j];
    if (m.jnt_type[j] != mjJNT_HINGE || !is_below(m, body, base_body)) continue;
    std::vector<int> joints;
    for (int b = body; b > base_body; b = m.body_parentid[b])
      for (int k = m.body_jntnum[b] - 1; k >= 0; --k) joints.push_back(m.body_jntadr[b] + k);
    bool last = true;
    for (int other = 0; other < m.njnt; ++other)
      if (other != j && m.jnt_bodyid[other] != body && is_below(m, m.jnt_bodyid[other], body))
        last = false;
    if (last && joints.size() == 3 && joints[0] == j)
      chains.push_back({joints[2], joints[1], joints[0]});
  }
  return chains;
}

}  // namespace

Result<Quadruped> find_quadruped(const mjModel& m, const RobotInstance& robot) {
  const auto not_a_quadruped = [&](const std::string& why) {
    return Error{.kind = ErrorKind::kUnsupported,
                 .message = "robot '" + robot.name +
                            "' is not a quadruped that the trot controller can control: " + why,
                 .loc = robot.options.controller.loc,
                 .hint = "it needs a free joint and four legs of three hinge joints each"};
  };
  Quadruped out;
  for (int b = robot.root_body; b < m.nbody && out.base_body < 0; ++b) {
    if (!is_below(m, b, robot.root_body)) continue;
    for (int k = 0; k < m.body_jntnum[b]; ++k)
      if (m.jnt_type[m.body_jntadr[b] + k] == mjJNT_FREE) {
        out.base_body = b;
        out.base_qpos = m.jnt_qposadr[m.body_jntadr[b] + k];
        out.base_dof = m.jnt_dofadr[m.body_jntadr[b] + k];
      }
  }
  if (out.base_body < 0) return not_a_quadruped("it has no free joint");

  const DataPtr data = make_data(m);
  mj_kinematics(&m, data.get());
  mj_comPos(&m, data.get());
  const mjData& d = *data;
  const Matrix3d R_WB = mat(d.xmat + 9 * out.base_body);
  const Vector3d p_WB = vec(d.xpos + 3 * out.base_body);

  GLOAM_TRY(const NamedLegs named, named_legs(m, robot));
  std::vector<std::array<int, 3>> chains;
  if (named.joints)
    chains.assign(named.joints->begin(), named.joints->end());
  else
    chains = find_chains(m, out.base_body);
  if (chains.size() != 4)
    return not_a_quadruped("it has " + std::to_string(chains.size()) + " legs of three joints");

  std::array<bool, 4> taken{};
  for (size_t c = 0; c < chains.size(); ++c) {
    const auto& chain = chains[c];
    Leg leg;
    for (int i = 0; i < 3; ++i) {
      const int j = chain[i], dof = m.jnt_dofadr[j];
      if (m.jnt_type[j] != mjJNT_HINGE)
        return not_a_quadruped("a leg has a joint that is not a hinge");
      leg.qpos[i] = m.jnt_qposadr[j];
      leg.dof[i] = dof;
      leg.q_ref[i] = d.qpos[leg.qpos[i]];
      leg.axis_B[i] = R_WB.transpose() * vec(d.xaxis + 3 * j);
      leg.anchor_B[i] = R_WB.transpose() * (vec(d.xanchor + 3 * j) - p_WB);
      leg.armature[i] = m.dof_armature[dof];
      leg.damping[i] = m.dof_damping[dof];
      leg.friction[i] = m.dof_frictionloss[dof];
      const bool shares_body = i < 2 && m.jnt_bodyid[chain[i + 1]] == m.jnt_bodyid[j];
      const Rigid link =
          shares_body ? Rigid{} : rigid_of(m, d, m.body_weldid[m.jnt_bodyid[j]], R_WB, p_WB);
      leg.mass[i] = link.mass;
      leg.com_B[i] = link.com;
      leg.inertia_B[i] = link.inertia;
      GLOAM_TRY_STATUS(find_motor(m, j, i, leg));
    }
    const int corner = (leg.anchor_B[0].x() > 0 ? 0 : 2) + (leg.anchor_B[0].y() > 0 ? 0 : 1);
    const int slot = named.joints ? static_cast<int>(c) : corner;
    const int calf = m.jnt_bodyid[chain[2]];
    const NamedFoot foot = named.feet ? (*named.feet)[slot] : NamedFoot{.carrier = calf};
    if (m.body_weldid[foot.carrier] != m.body_weldid[calf])
      return not_a_quadruped("the foot '" + robot.options.joints.feet[slot] +
                             "' is not on the last link of its leg");
    GLOAM_TRY_STATUS(find_foot(m, d, calf, {R_WB, p_WB}, foot, leg));
    leg.length = (leg.anchor_B[2] - leg.anchor_B[1]).norm() + (leg.foot_B - leg.anchor_B[2]).norm();
    if (taken[slot]) return not_a_quadruped("its hips are not at four corners around the base");
    taken[slot] = true;
    out.leg_length += leg.length / 4;
    for (const double mass : leg.mass) out.mass += mass;
    out.legs[slot] = leg;
  }
  const Rigid base = rigid_of(m, d, m.body_weldid[out.base_body], R_WB, p_WB);
  out.base_mass = base.mass;
  out.base_com_B = base.com;
  out.base_inertia_B = base.inertia;
  out.mass += base.mass;
  out.gravity = vec(m.opt.gravity).norm();
  return out;
}

}  // namespace gloam
