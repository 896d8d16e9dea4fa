#include "control/actuators/drive.h"

#include <fmt/format.h>
#include <re2/re2.h>

#include <algorithm>

#include "base/text.h"
#include "control/robot_joints.h"
#include "world/model_names.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

// A hinge or slide of the robot, by the name that it has in the robot's own model.
struct NamedJoint {
  std::string name;
  int id;
};

std::vector<NamedJoint> joints_of(const mjModel& m, const RobotInstance& robot) {
  std::vector<NamedJoint> joints;
  for (const int id : robot_joints(m, robot)) {
    if (m.jnt_type[id] != mjJNT_HINGE && m.jnt_type[id] != mjJNT_SLIDE) continue;
    std::string name = joint_name(m, id, robot);
    if (!name.empty()) joints.push_back({std::move(name), id});
  }
  return joints;
}

std::vector<int> actuators_on(const mjModel& m, int joint) {
  std::vector<int> found;
  for (int i = 0; i < m.nactuator; ++i) {
    const int type = m.actuator_trntype[i];
    if ((type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT) && m.actuator_trnid[2 * i] == joint)
      found.push_back(i);
  }
  return found;
}

Error at(const ActuatorOptions& o, std::string message, std::string hint) {
  return {ErrorKind::kInput, std::move(message), o.loc, std::move(hint)};
}

// Force = gain · control + a bias that is linear in position and velocity, and nothing else.
bool is_affine(const mjModel& m, int actuator) {
  return m.actuator_ctrlnum[actuator] == 1 && m.actuator_outnum[actuator] == 1 &&
         m.actuator_actnum[actuator] == 0 && m.actuator_historyadr[actuator] < 0 &&
         m.actuator_gaintype[actuator] == mjGAIN_FIXED &&
         m.actuator_gainprm[mjNGAIN * actuator] != 0 &&
         m.actuator_gear[6 * m.actuator_outadr[actuator]] != 0 &&
         (m.actuator_biastype[actuator] == mjBIAS_NONE ||
          m.actuator_biastype[actuator] == mjBIAS_AFFINE);
}

bool has_feedback(const mjModel& m, int actuator) {
  const mjtNum* bias = m.actuator_biasprm + mjNBIAS * actuator;
  return m.actuator_biastype[actuator] == mjBIAS_AFFINE && (bias[1] != 0 || bias[2] != 0);
}

Status check_network(const DriveSetup& drive, const std::string& robot) {
  const ActuatorOptions& o = drive.options;
  if (!o.network) return {};
  if (drive.takes_target && o.network->kp)
    return at(o,
              fmt::format("the actuator of joint '{}' of robot '{}' is a servo, whose control is "
                          "the network's target",
                          drive.name, robot),
              "remove 'kp' and 'kd' of 'network'");
  if (!drive.takes_target && !o.network->kp)
    return at(o,
              fmt::format("the actuator of joint '{}' of robot '{}' is a motor, so that the "
                          "network has no target",
                          drive.name, robot),
              "specify 'kp' and 'kd' of the controller that commands its torque, or use <position> "
              "actuators");
  return {};
}

Result<DriveSetup> make_drive(const mjModel& m, const RobotInstance& robot, const NamedJoint& joint,
                              const ActuatorOptions& options) {
  const std::vector<int> actuators = actuators_on(m, joint.id);
  if (actuators.size() != 1)
    return at(options,
              fmt::format("joint '{}' of robot '{}' has {} actuators instead of one", joint.name,
                          robot.name, actuators.size()),
              actuators.empty() ? "add a <motor> to the model, or match fewer joints"
                                : "match fewer joints");
  const int actuator = actuators[0];
  if (!is_affine(m, actuator))
    return at(options,
              fmt::format("the actuator of joint '{}' of robot '{}' has an activation, a delay, or "
                          "a force that is not linear in control, position and velocity",
                          joint.name, robot.name),
              "use <motor>, <position> or <velocity>, or match fewer joints");
  DriveSetup drive;
  drive.name = joint.name;
  drive.joint = joint.id;
  drive.qpos = m.jnt_qposadr[joint.id];
  drive.dof = m.jnt_dofadr[joint.id];
  drive.actuator = actuator;
  drive.ctrl = m.actuator_ctrladr[actuator];
  drive.output = m.actuator_outadr[actuator];
  drive.takes_target = has_feedback(m, actuator);
  drive.options = options;
  GLOAM_TRY_STATUS(check_network(drive, robot.name));
  return drive;
}

}  // namespace

Result<std::vector<DriveSetup>> find_drives(const mjModel& model, const RobotInstance& robot) {
  const std::vector<NamedJoint> joints = joints_of(model, robot);
  std::vector<const ActuatorOptions*> chosen(joints.size(), nullptr);
  for (const ActuatorOptions& row : robot.options.actuator) {
    const RE2 pattern(row.joints, RE2::Quiet);
    bool matches = false;
    for (size_t i = 0; i < joints.size(); ++i) {
      if (!RE2::FullMatch(joints[i].name, pattern)) continue;
      chosen[i] = &row;
      matches = true;
    }
    if (matches) continue;
    std::vector<std::string> names;
    for (const NamedJoint& joint : joints) names.push_back(joint.name);
    return at(row, fmt::format("no joint of robot '{}' matches '{}'", robot.name, row.joints),
              suggest_name(row.joints, names));
  }
  std::vector<DriveSetup> drives;
  for (size_t i = 0; i < joints.size(); ++i) {
    if (chosen[i] == nullptr) continue;
    GLOAM_TRY(DriveSetup drive, make_drive(model, robot, joints[i], *chosen[i]));
    drives.push_back(std::move(drive));
  }
  return drives;
}

}  // namespace gloam
