#pragma once
// A robot of tests: two hinges that hang below a floating base, over ground with a step.

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "policy/policy.h"

namespace gloam {

inline constexpr const char* kLegActuators =
    R"(<motor name="m_hip" joint="hip"/><motor name="m_knee" joint="knee" gear="2"/>)";

struct LegRobot {
  explicit LegRobot(const std::string& actuators = kLegActuators);
  int joint(const char* name) const { return mj_name2id(model.get(), mjOBJ_JOINT, name); }
  double& q(const char* name) { return data->qpos[model->jnt_qposadr[joint(name)]]; }
  double& qd(const char* name) { return data->qvel[model->jnt_dofadr[joint(name)]]; }
  double& ctrl(int actuator) { return data->ctrl[actuator]; }
  Result<std::unique_ptr<PolicyRunner>> run(std::shared_ptr<const Policy> policy) const {
    const TermBinding binding{model.get(), &robot, &policy->spec};
    return PolicyRunner::create(policy, binding, policy->spec.gait);
  }

  ModelPtr model;
  DataPtr data;
  RobotInstance robot;
};

/// Settings of a policy for it; [[observation]] or [[network]] tables follow.
inline constexpr const char* kLegPolicy = R"(
[policy]
rate = 50
joints = ["knee", "hip"]
kp = [10.0, 20.0]
kd = 0.5
default_positions = [0.3, -0.2]
action_scale = 0.5
)";

}  // namespace gloam
