#include "policy/policy_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "policy/terms/body_pose.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

constexpr double kSameGain = 2e-3;  // relative: mjlab rounds gains to three decimals

Error missing_from(const TermBinding& binding, std::string_view what,
                   const std::vector<std::string>& missing, mjtObj type) {
  const std::vector<std::string> names = names_of(*binding.model, *binding.robot, type);
  const std::string near = nearest_name(missing[0], names);
  return {ErrorKind::kInput,
          fmt::format("robot '{}' has no {} {}, which the policy requires", binding.robot->name,
                      what, joined(missing)),
          {},
          (near.empty() ? "" : fmt::format("did you mean '{}'? ", near)) +
              fmt::format("{}s of the robot: {}", what, names.empty() ? "none" : joined(names))};
}

/// Name in the model: the robot's prefix before the policy's name without its own prefix.
std::string model_name(const TermBinding& binding, const std::string& joint) {
  const auto& renamed = binding.spec->model_joints;
  const auto found = renamed.find(joint);
  const std::string& name = found != renamed.end() ? found->second : joint;
  return binding.robot->prefix + name.substr(name.rfind('/') + 1);
}

bool is_close(double a, double b) { return std::abs(a - b) <= kSameGain * std::abs(b) + 1e-8; }

}  // namespace

Result<PolicyRobot> PolicyRobot::create(const TermBinding& binding) {
  PolicyRobot made;
  GLOAM_TRY_STATUS(made.find_joints(binding));
  GLOAM_TRY_STATUS(made.find_base(binding));
  GLOAM_TRY_STATUS(made.find_sensors(binding));
  return made;
}

Status PolicyRobot::find_joints(const TermBinding& binding) {
  const mjModel& model = *binding.model;
  const PolicySpec& spec = *binding.spec;
  std::vector<std::string> missing, undriven;
  for (const std::string& joint : spec.joints) {
    joint_names_.push_back(model_name(binding, joint));
    if (mj_name2id(&model, mjOBJ_JOINT, joint_names_.back().c_str()) < 0)
      missing.push_back(joint_names_.back());
  }
  if (!missing.empty()) return missing_from(binding, "joint", missing, mjOBJ_JOINT);
  for (size_t i = 0; i < joint_names_.size(); ++i) {
    const int id = mj_name2id(&model, mjOBJ_JOINT, joint_names_[i].c_str());
    if (model.jnt_type[id] != mjJNT_HINGE && model.jnt_type[id] != mjJNT_SLIDE)
      return Error{
          ErrorKind::kUnsupported,
          fmt::format("joint '{}' of the policy is neither a hinge nor a slide", spec.joints[i])};
    Joint joint;
    joint.qpos = model.jnt_qposadr[id];
    joint.dof = model.jnt_dofadr[id];
    joint.kp = spec.kp[i], joint.kd = spec.kd[i], joint.limit = spec.torque_limit[i];
    GLOAM_TRY_STATUS(find_actuator(binding, id, &joint));
    joints_.push_back(joint);
  }
  is_servo_ = std::ranges::all_of(joints_, [&](const Joint& j) { return takes_targets(j); });
  return {};
}

Status PolicyRobot::find_actuator(const TermBinding& binding, int joint, Joint* out) const {
  const mjModel& model = *binding.model;
  const char* name = mj_id2name(&model, mjOBJ_JOINT, joint);
  std::vector<int> found;
  for (int a = 0; a < model.nactuator; ++a)
    if ((model.actuator_trntype[a] == mjTRN_JOINT ||
         model.actuator_trntype[a] == mjTRN_JOINTINPARENT) &&
        model.actuator_trnid[2 * a] == joint)
      found.push_back(a);
  if (found.size() != 1)
    return Error{
        ErrorKind::kInput,
        fmt::format("joint '{}' has {}", name, found.empty() ? "no actuator" : "several actuators"),
        {},
        "a policy drives each joint with one motor or position servo; docs/policies.md "
        "shows how to add them"};
  const int a = found[0];
  const std::vector<int>& own = binding.robot->actuators;
  if (!own.empty() && !std::ranges::binary_search(own, a))
    return Error{ErrorKind::kInput,
                 fmt::format("the policy drives joint '{}', but the parts of robot '{}' give it to "
                             "another controller",
                             name, binding.robot->name),
                 {},
                 "list all joints of the policy in its own [[robot.part]], or in no part if the "
                 "robot itself has the policy"};
  const bool has_bias = model.actuator_biastype[a] == mjBIAS_AFFINE;
  out->gear = model.actuator_gear[6 * model.actuator_outadr[a]];
  out->gain = model.actuator_gainprm[mjNGAIN * a];
  out->ctrl = model.actuator_ctrladr[a];
  if (model.actuator_gaintype[a] != mjGAIN_FIXED || model.actuator_actnum[a] != 0 ||
      model.actuator_ctrlnum[a] != 1 || (!has_bias && model.actuator_biastype[a] != mjBIAS_NONE) ||
      out->gain * out->gear == 0)
    return Error{ErrorKind::kUnsupported,
                 fmt::format("the actuator of '{}' is neither a motor nor a position servo", name),
                 {},
                 "policies cannot drive filters, muscles and other actuator dynamics"};
  for (int i = 0; has_bias && i < 3; ++i) out->bias[i] = model.actuator_biasprm[mjNBIAS * a + i];
  return {};
}

// A servo of the policy's own gains computes the torque itself, at MuJoCo's own instants.
bool PolicyRobot::takes_targets(const Joint& joint) const {
  const double square = joint.gear * joint.gear;
  return is_close(joint.gain * square, joint.kp) && is_close(-joint.bias[1] * square, joint.kp) &&
         is_close(-joint.bias[2] * square, joint.kd) && std::isinf(joint.limit) &&
         joint.bias[0] == 0;
}

Status PolicyRobot::find_base(const TermBinding& binding) {
  const mjModel& model = *binding.model;
  const int first = mj_name2id(&model, mjOBJ_JOINT, joint_names_[0].c_str());
  const int free = floating_joint(model, model.jnt_bodyid[first]);
  if (free >= 0) {
    base_qpos_ = model.jnt_qposadr[free];
    base_dof_ = model.jnt_dofadr[free];
    return {};
  }
  const auto missing = [&](std::string use, std::string remedy) {
    return Error{
        ErrorKind::kUnsupported,
        fmt::format("the policy {}, but robot '{}' has no floating base", use, binding.robot->name),
        {},
        "set base = \"free\" in its [[robot]], or " + remedy};
  };
  if (binding.spec->velocity_feedback > 0)
    return missing("has a velocity_feedback", "remove it from the policy's settings");
  for (const NetworkSpec& network : binding.spec->networks)
    for (const ObservationPart& part : network.parts)
      if (part.sensor.empty() && part.term->needs_base())
        return missing(fmt::format("observes '{}'", part.kind->name), "give the term a sensor");
  return {};
}

Status PolicyRobot::find_sensors(const TermBinding& binding) {
  const mjModel& model = *binding.model;
  std::vector<std::string> missing;
  for (const NetworkSpec& network : binding.spec->networks) {
    for (const ObservationPart& part : network.parts) {
      if (part.sensor.empty()) continue;
      const std::string full = part.sensor.find('/') != std::string::npos
                                   ? part.sensor
                                   : binding.robot->prefix + part.sensor;
      const int id = mj_name2id(&model, mjOBJ_SENSOR, full.c_str());
      if (id < 0) {
        missing.push_back(full);
        continue;
      }
      const int size = model.sensor_dim[id];
      if (static_cast<size_t>(size) != part.term->size())
        return Error{ErrorKind::kUnsupported,
                     fmt::format("sensor '{}' has {} numbers, but term '{}' has {}", part.sensor,
                                 size, part.kind->name, part.term->size()),
                     part.loc};
      sensors_.push_back({part.sensor, model.sensor_adr[id], size});
    }
  }
  if (!missing.empty()) return missing_from(binding, "sensor", missing, mjOBJ_SENSOR);
  return {};
}

void PolicyRobot::measure(const mjData& data, RobotState* out) const {
  for (size_t i = 0; i < joints_.size(); ++i) {
    out->q[i] = data.qpos[joints_[i].qpos];
    out->qd[i] = data.qvel[joints_[i].dof];
  }
  if (base_qpos_ < 0) return;
  const mjtNum* p = data.qpos + base_qpos_;
  const mjtNum* v = data.qvel + base_dof_;
  const double w = p[3], x = p[4], y = p[5], z = p[6];
  std::copy_n(p, 3, out->p_WB.begin());
  auto& R = out->R_WB;
  R = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
       2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
       2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  // Velocities of a free joint: the linear one is in world axes, the angular one in the body's.
  for (size_t i = 0; i < 3; ++i) {
    out->v_B[i] = R[i] * v[0] + R[3 + i] * v[1] + R[6 + i] * v[2];
    out->omega_B[i] = v[3 + i];
    out->gravity_B[i] = -R[6 + i];
  }
}

std::span<const double> PolicyRobot::reading(const mjData& data,
                                             const ObservationPart& part) const {
  if (part.sensor.empty()) return {};
  for (const Sensor& sensor : sensors_)
    if (sensor.name == part.sensor)
      return {data.sensordata + sensor.address, static_cast<size_t>(sensor.size)};
  return {};
}

// force = gain * control + bias, torque = gear * force; MuJoCo's documentation, "Computation".
void PolicyRobot::write_torque(const Joint& joint, double torque, mjData* data) {
  const double q = data->qpos[joint.qpos], v = data->qvel[joint.dof];
  const double force =
      torque / joint.gear - joint.bias[0] - joint.gear * (joint.bias[1] * q + joint.bias[2] * v);
  data->ctrl[joint.ctrl] = force / joint.gain;
}

void PolicyRobot::drive(std::span<const double> targets, mjData* data) const {
  for (size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    if (is_servo_) {
      data->ctrl[joint.ctrl] = targets[i] * joint.gear;
      continue;
    }
    const double torque =
        joint.kp * (targets[i] - data->qpos[joint.qpos]) - joint.kd * data->qvel[joint.dof];
    write_torque(joint, std::clamp(torque, -joint.limit, joint.limit), data);
  }
}

void PolicyRobot::damp(mjData* data) const {
  for (const Joint& joint : joints_)
    write_torque(joint, std::clamp(-joint.kd * data->qvel[joint.dof], -joint.limit, joint.limit),
                 data);
}

}  // namespace gloam
