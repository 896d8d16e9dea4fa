#include "control/flight/rotors.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>

#include "world/world_robots.h"

namespace gloam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kSmallestSingularValue = 1e-6;  // of the effectiveness, relative to the largest

Matrix3d matrix(const mjtNum* p) { return Eigen::Map<const RowMatrix3d>(p); }

// A thrust at a site: one control, a constant gain, and perhaps the lag of a motor.
bool is_rotor(const mjModel& model, int actuator, int root) {
  if (model.actuator_trntype[actuator] != mjTRN_SITE || model.actuator_ctrlnum[actuator] != 1 ||
      model.actuator_trnid[2 * actuator + 1] >= 0 ||
      model.actuator_gaintype[actuator] != mjGAIN_FIXED ||
      model.actuator_biastype[actuator] != mjBIAS_NONE ||
      model.actuator_gainprm[mjNGAIN * actuator] == 0) {
    return false;
  }
  const int dynamics = model.actuator_dyntype[actuator];
  const bool has_lag = dynamics == mjDYN_FILTER || dynamics == mjDYN_FILTEREXACT;
  const int site = model.actuator_trnid[2 * actuator];
  return (dynamics == mjDYN_NONE || has_lag) && is_part_of(model, model.site_bodyid[site], root);
}

Rotor rotor_of(const mjModel& model, int actuator) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Rotor rotor;
  rotor.ctrl = model.actuator_ctrladr[actuator];
  rotor.gain = model.actuator_gainprm[mjNGAIN * actuator];
  double a = -kInfinity, b = kInfinity;
  if (model.actuator_ctrllimited[rotor.ctrl]) {
    a = rotor.gain * model.actuator_ctrlrange[2 * rotor.ctrl];
    b = rotor.gain * model.actuator_ctrlrange[2 * rotor.ctrl + 1];
  }
  rotor.lowest = std::min(a, b);
  rotor.highest = std::max(a, b);
  if (model.actuator_forcelimited[actuator]) {
    rotor.lowest = std::max(rotor.lowest, model.actuator_forcerange[2 * actuator]);
    rotor.highest = std::min(rotor.highest, model.actuator_forcerange[2 * actuator + 1]);
  }
  return rotor;
}

Error unsuited(const RobotInstance& robot, std::string_view reason, std::string hint) {
  return Error{ErrorKind::kInput,
               fmt::format("controller 'quadrotor' cannot fly robot '{}': {}", robot.name, reason),
               robot.options.controller.loc, std::move(hint)};
}

// Mass and inertia about the centre of mass of everything that hangs on the base.
void add_up(const mjModel& model, const mjData& data, int root, Multirotor* out) {
  const Matrix3d R_WB = matrix(data.xmat + 9 * root);
  const Vector3d com_W = Vector3d(data.subtree_com + 3 * root);
  Matrix3d inertia_W = Matrix3d::Zero();
  for (int body = root; body < model.nbody; ++body) {
    if (!is_part_of(model, body, root)) continue;
    const double mass = model.body_mass[body];
    const Matrix3d R = matrix(data.ximat + 9 * body);
    const Vector3d r = Vector3d(data.xipos + 3 * body) - com_W;
    inertia_W += R * Vector3d(model.body_inertia + 3 * body).asDiagonal() * R.transpose() +
                 mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
    out->mass += mass;
  }
  out->inertia_B = R_WB.transpose() * inertia_W * R_WB;
}

}  // namespace

Result<Multirotor> find_multirotor(const mjModel& model, const RobotInstance& robot) {
  const int root = robot.root_body;
  const int joint = model.body_jntadr[root];
  if (joint < 0 || model.jnt_type[joint] != mjJNT_FREE)
    return unsuited(robot, "its root body has no free joint", "set base = \"free\"");
  const DataPtr data(mj_makeData(&model));
  if (!data) return Error{ErrorKind::kIo, "out of memory"};
  mj_kinematics(&model, data.get());
  mj_comPos(&model, data.get());

  Multirotor out;
  out.qpos = model.jnt_qposadr[joint];
  out.dof = model.jnt_dofadr[joint];
  add_up(model, *data, root, &out);
  const Matrix3d R_WB = matrix(data->xmat + 9 * root);
  const Vector3d com_W = Vector3d(data->subtree_com + 3 * root);
  std::vector<Eigen::Vector4d> columns;
  for (int actuator = 0; actuator < model.nactuator; ++actuator) {
    if (!is_rotor(model, actuator, root)) continue;
    const int site = model.actuator_trnid[2 * actuator];
    const mjtNum* gear = model.actuator_gear + 6 * model.actuator_outadr[actuator];
    const Matrix3d R_WS = matrix(data->site_xmat + 9 * site);
    const Vector3d force_W = R_WS * Vector3d(gear);
    const Vector3d arm_W = Vector3d(data->site_xpos + 3 * site) - com_W;
    const Vector3d torque_B = R_WB.transpose() * (R_WS * Vector3d(gear + 3) + arm_W.cross(force_W));
    columns.emplace_back((R_WB.transpose() * force_W).z(), torque_B.x(), torque_B.y(),
                         torque_B.z());
    out.rotors.push_back(rotor_of(model, actuator));
  }
  if (columns.size() < 4) {
    return unsuited(robot,
                    fmt::format("it has {} rotors, and at least 4 are needed", columns.size()),
                    "a rotor is an actuator at a site whose gear is its thrust and torque");
  }
  out.effectiveness.resize(4, static_cast<Eigen::Index>(columns.size()));
  for (size_t i = 0; i < columns.size(); ++i)
    out.effectiveness.col(static_cast<Eigen::Index>(i)) = columns[i];
  const Eigen::Vector4d values =
      Eigen::JacobiSVD<Eigen::MatrixXd>(out.effectiveness).singularValues();
  if (!(values[3] > kSmallestSingularValue * values[0])) {
    return unsuited(robot, "its rotors cannot produce a thrust and torques about all three axes",
                    "rotors need reaction torques of both signs: gear = [0, 0, 1, 0, 0, ±k]");
  }
  return out;
}

}  // namespace gloam
