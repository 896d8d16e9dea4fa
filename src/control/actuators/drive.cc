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

// A hinge or slide of the robot, or an actuator that pushes at a site of it, by the name that it
// has in the robot's own model.
struct Candidate {
  std::string name;
  int id;
  bool is_joint;
};

std::vector<Candidate> candidates_of(const mjModel& m, const RobotInstance& robot) {
  std::vector<Candidate> found;
  for (const int id : robot_joints(m, robot)) {
    if (m.jnt_type[id] != mjJNT_HINGE && m.jnt_type[id] != mjJNT_SLIDE) continue;
    std::string name = joint_name(m, id, robot);
    if (!name.empty()) found.push_back({std::move(name), id, true});
  }
  for (const int id : robot_actuators(m, robot)) {
    if (m.actuator_trntype[id] != mjTRN_SITE || m.actuator_trnid[2 * id + 1] >= 0) continue;
    std::string name = actuator_name(m, id, robot);
    if (!name.empty()) found.push_back({std::move(name), id, false});
  }
  return found;
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

// The indices of an actuator.
DriveSetup setup_of(const mjModel& m, int actuator, const Candidate& of,
                    const ActuatorOptions& options) {
  DriveSetup drive;
  drive.name = of.name;
  drive.actuator = actuator;
  drive.ctrl = m.actuator_ctrladr[actuator];
  drive.output = m.actuator_outadr[actuator];
  drive.options = options;
  return drive;
}

Result<DriveSetup> make_propeller(const mjModel& m, const RobotInstance& robot,
                                  const Candidate& propeller, const ActuatorOptions& options) {
  const int actuator = propeller.id;
  const mjtNum* gear = m.actuator_gear + 6 * m.actuator_outadr[actuator];
  if (!is_affine(m, actuator) || m.actuator_biastype[actuator] != mjBIAS_NONE)
    return at(options,
              fmt::format("actuator '{}' of robot '{}' has an activation or a bias, which the "
                          "propeller's model replaces",
                          propeller.name, robot.name),
              "use <motor site=…>, without dyntype and biastype");
  if (mju_dot3(gear, gear) == 0)
    return at(
        options,
        fmt::format("actuator '{}' of robot '{}' gives no thrust", propeller.name, robot.name),
        "its gear is the direction of the thrust and the reaction torque: 0 0 1 0 0 0.02");
  DriveSetup drive = setup_of(m, actuator, propeller, options);
  drive.site = m.actuator_trnid[2 * actuator];
  return drive;
}

Result<DriveSetup> make_drive(const mjModel& m, const RobotInstance& robot, const Candidate& joint,
                              const ActuatorOptions& options) {
  const std::vector<int> actuators = actuators_on(m, joint.id);
  if (actuators.size() != 1)
    return at(options,
              fmt::format("joint '{}' of robot '{}' has {} actuators instead of one", joint.name,
                          robot.name, actuators.size()),
              actuators.empty() ? "add a <motor> to the model, or match fewer joints"
                                : "match fewer joints");
  const int actuator = actuators[0];
  if (!is_affine(m, actuator) || m.actuator_gear[6 * m.actuator_outadr[actuator]] == 0)
    return at(options,
              fmt::format("the actuator of joint '{}' of robot '{}' has an activation, a delay, or "
                          "a force that is not linear in control, position and velocity",
                          joint.name, robot.name),
              "use <motor>, <position> or <velocity>, or match fewer joints");
  DriveSetup drive = setup_of(m, actuator, joint, options);
  drive.joint = joint.id;
  drive.qpos = m.jnt_qposadr[joint.id];
  drive.dof = m.jnt_dofadr[joint.id];
  drive.takes_target = has_feedback(m, actuator);
  GLOAM_TRY_STATUS(check_network(drive, robot.name));
  return drive;
}

}  // namespace

Result<std::vector<DriveSetup>> find_drives(const mjModel& model, const RobotInstance& robot) {
  const std::vector<Candidate> candidates = candidates_of(model, robot);
  std::vector<const ActuatorOptions*> chosen(candidates.size(), nullptr);
  for (const ActuatorOptions& row : robot.options.actuator) {
    const bool is_joint = !row.propeller;
    const std::string& text = is_joint ? row.joints : row.actuators;
    const RE2 pattern(text, RE2::Quiet);
    std::vector<std::string> names;
    bool matches = false;
    for (size_t i = 0; i < candidates.size(); ++i) {
      if (candidates[i].is_joint != is_joint) continue;
      names.push_back(candidates[i].name);
      if (!RE2::FullMatch(candidates[i].name, pattern)) continue;
      chosen[i] = &row;
      matches = true;
    }
    if (matches) continue;
    return at(row,
              fmt::format("no {} of robot '{}' matches '{}'",
                          is_joint ? "joint" : "actuator at a site", robot.name, text),
              suggest_name(text, names));
  }
  std::vector<DriveSetup> drives;
  for (size_t i = 0; i < candidates.size(); ++i) {
    if (chosen[i] == nullptr) continue;
    const auto make = candidates[i].is_joint ? make_drive : make_propeller;
    GLOAM_TRY(DriveSetup drive, make(model, robot, candidates[i], *chosen[i]));
    drives.push_back(std::move(drive));
  }
  return drives;
}

}  // namespace gloam
