#include "control/robot_joints.h"

#include <algorithm>
#include <limits>

#include "world/model_names.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

// kp u - kp q - kv v, as MJCF's <position> makes it.
bool is_position_servo(const mjModel& model, int actuator) {
  const double kp = model.actuator_gainprm[mjNGAIN * actuator];
  return model.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         model.actuator_biastype[actuator] == mjBIAS_AFFINE && kp != 0 &&
         model.actuator_biasprm[mjNBIAS * actuator + 1] == -kp;
}

bool is_motor(const mjModel& model, int actuator) {
  return model.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         model.actuator_biastype[actuator] == mjBIAS_NONE &&
         model.actuator_gainprm[mjNGAIN * actuator] != 0;
}

// kv u - kv v, as MJCF's <velocity> makes it.
bool is_velocity_servo(const mjModel& model, int actuator) {
  const double kv = model.actuator_gainprm[mjNGAIN * actuator];
  return model.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         model.actuator_biastype[actuator] == mjBIAS_AFFINE && kv != 0 &&
         model.actuator_biasprm[mjNBIAS * actuator + 1] == 0 &&
         model.actuator_biasprm[mjNBIAS * actuator + 2] == -kv;
}

std::string without_prefix(std::string name, const RobotInstance& robot) {
  if (name.starts_with(robot.prefix)) name.erase(0, robot.prefix.size());
  return name;
}

}  // namespace

double control_of_torque(const DrivenJoint& motor, double torque) {
  const double force = std::clamp(torque / motor.gear, motor.force_lowest, motor.force_highest);
  return std::clamp(force / motor.gain, motor.lowest, motor.highest);
}

double control_of_position(const DrivenJoint& joint, const mjData& data, double target,
                           double velocity, double kp, double kd) {
  if (joint.takes_target) return std::clamp(joint.gear * target, joint.lowest, joint.highest);
  return control_of_torque(
      joint, kp * (target - data.qpos[joint.qpos]) + kd * (velocity - data.qvel[joint.dof]));
}

std::string joint_name(const mjModel& model, int joint, const RobotInstance& robot) {
  return without_prefix(name_of(model, mjOBJ_JOINT, joint), robot);
}

std::string actuator_name(const mjModel& model, int actuator, const RobotInstance& robot) {
  return without_prefix(name_of(model, mjOBJ_ACTUATOR, actuator), robot);
}

bool may_use(const RobotInstance& robot, int actuator) {
  return robot.actuators.empty() || std::ranges::binary_search(robot.actuators, actuator);
}

std::optional<DrivenJoint> actuator_terms(const mjModel& model, int actuator,
                                          VelocityServos velocity_servos) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (model.actuator_ctrlnum[actuator] != 1 || model.actuator_actnum[actuator] != 0) return {};
  DrivenJoint row;
  row.takes_target = is_position_servo(model, actuator);
  row.takes_velocity =
      velocity_servos == VelocityServos::kInclude && is_velocity_servo(model, actuator);
  if (!row.takes_target && !row.takes_velocity && !is_motor(model, actuator)) return {};
  row.actuator = actuator;
  row.ctrl = model.actuator_ctrladr[actuator];
  row.gear = model.actuator_gear[6 * model.actuator_outadr[actuator]];
  row.gain = model.actuator_gainprm[mjNGAIN * actuator];
  if (row.takes_target || row.takes_velocity)
    std::copy_n(model.actuator_biasprm + mjNBIAS * actuator, 3, row.bias);
  const bool ctrl_limited = model.actuator_ctrllimited[row.ctrl];
  row.lowest = ctrl_limited ? model.actuator_ctrlrange[2 * row.ctrl] : -kInfinity;
  row.highest = ctrl_limited ? model.actuator_ctrlrange[2 * row.ctrl + 1] : kInfinity;
  const bool force_limited = model.actuator_forcelimited[actuator];
  row.force_lowest = force_limited ? model.actuator_forcerange[2 * actuator] : -kInfinity;
  row.force_highest = force_limited ? model.actuator_forcerange[2 * actuator + 1] : kInfinity;
  return row;
}

std::vector<DrivenJoint> driven_joints(const mjModel& model, const RobotInstance& robot,
                                       VelocityServos velocity_servos) {
  std::vector<DrivenJoint> driven;
  for (int actuator = 0; actuator < model.nactuator; ++actuator) {
    if (!may_use(robot, actuator) || model.actuator_trntype[actuator] != mjTRN_JOINT) continue;
    const int joint = model.actuator_trnid[2 * actuator];
    const int type = model.jnt_type[joint];
    if ((type != mjJNT_HINGE && type != mjJNT_SLIDE) ||
        !is_part_of(model, model.jnt_bodyid[joint], robot.root_body)) {
      continue;
    }
    std::optional<DrivenJoint> row = actuator_terms(model, actuator, velocity_servos);
    if (!row) continue;
    row->name = joint_name(model, joint, robot);
    row->joint = joint;
    row->qpos = model.jnt_qposadr[joint];
    row->dof = model.jnt_dofadr[joint];
    row->inertia = 1 / model.dof_invweight0[row->dof];
    driven.push_back(std::move(*row));
  }
  return driven;
}

std::vector<int> joints_of_tendon(const mjModel& model, int tendon) {
  std::vector<int> joints;
  for (int i = 0; i < model.tendon_num[tendon]; ++i) {
    const int wrap = model.tendon_adr[tendon] + i;
    if (model.wrap_type[wrap] == mjWRAP_JOINT) joints.push_back(model.wrap_objid[wrap]);
  }
  return joints;
}

}  // namespace gloam
