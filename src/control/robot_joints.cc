#include "control/robot_joints.h"

#include <limits>

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

}  // namespace

std::vector<DrivenJoint> driven_joints(const mjModel& model, const RobotInstance& robot) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<DrivenJoint> driven;
  for (int actuator = 0; actuator < model.nactuator; ++actuator) {
    if (model.actuator_trntype[actuator] != mjTRN_JOINT || model.actuator_ctrlnum[actuator] != 1 ||
        model.actuator_actnum[actuator] != 0) {
      continue;
    }
    const int joint = model.actuator_trnid[2 * actuator];
    const int type = model.jnt_type[joint];
    const bool servo = is_position_servo(model, actuator);
    if ((type != mjJNT_HINGE && type != mjJNT_SLIDE) ||
        !is_part_of(model, model.jnt_bodyid[joint], robot.root_body) ||
        (!servo && !is_motor(model, actuator))) {
      continue;
    }
    DrivenJoint row;
    const char* name = mj_id2name(&model, mjOBJ_JOINT, joint);
    row.name = name == nullptr ? "" : name;
    if (row.name.starts_with(robot.prefix)) row.name.erase(0, robot.prefix.size());
    row.joint = joint;
    row.actuator = actuator;
    row.ctrl = model.actuator_ctrladr[actuator];
    row.qpos = model.jnt_qposadr[joint];
    row.dof = model.jnt_dofadr[joint];
    row.gear = model.actuator_gear[6 * model.actuator_outadr[actuator]];
    row.takes_target = servo;
    row.gain = model.actuator_gainprm[mjNGAIN * actuator];
    const bool ctrl_limited = model.actuator_ctrllimited[row.ctrl];
    row.lowest = ctrl_limited ? model.actuator_ctrlrange[2 * row.ctrl] : -kInfinity;
    row.highest = ctrl_limited ? model.actuator_ctrlrange[2 * row.ctrl + 1] : kInfinity;
    const bool force_limited = model.actuator_forcelimited[actuator];
    row.force_lowest = force_limited ? model.actuator_forcerange[2 * actuator] : -kInfinity;
    row.force_highest = force_limited ? model.actuator_forcerange[2 * actuator + 1] : kInfinity;
    driven.push_back(std::move(row));
  }
  return driven;
}

}  // namespace gloam
