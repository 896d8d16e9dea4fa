#include "sim/commands/applied_inputs.h"

#include <algorithm>
#include <cmath>

#include "sim/commands/command_check.h"
#include "world/world_robots.h"

namespace gloam {

AppliedInputs::AppliedInputs(const CompiledWorld& world, const mjModel& model)
    : wrench_(static_cast<size_t>(6 * model.nbody)),
      jacobian_(static_cast<size_t>(3 * model.nv)),
      solved_(static_cast<size_t>(3 * model.nv)),
      joints_(world, model) {
  drags_.reserve(static_cast<size_t>(model.nbody));
  for (const RobotInstance& robot : world.robots) {
    std::vector<int>& controls = controls_.emplace_back();
    for (const int actuator : robot_actuators(model, robot))
      controls.push_back(model.actuator_ctrladr[actuator]);
  }
}

void AppliedInputs::take_over(const AppliedInputs& before, const Correspondence& same) {
  for (size_t body = 0; body < same.body.size(); ++body) {
    const int old = same.body[body];
    if (old < 0) continue;
    mju_copy(wrench_.data() + 6 * body, before.wrench_.data() + 6 * old, 6);
    for (Drag drag : before.drags_) {
      if (drag.body != old) continue;
      drag.body = static_cast<int>(body);
      drags_.push_back(drag);
    }
  }
  joints_.take_over(before.joints_, same);
}

void AppliedInputs::reset() {
  std::fill(wrench_.begin(), wrench_.end(), 0.0);
  drags_.clear();
  joints_.reset();
}

void AppliedInputs::apply(const mjModel& model, mjData& data, const SetControl& command) {
  data.ctrl[model.actuator_ctrladr[command.actuator.id]] = command.value;
}

void AppliedInputs::apply(const mjModel&, mjData& data, const SetControls& command) {
  const std::vector<int>& controls = controls_[static_cast<size_t>(command.robot.id)];
  for (size_t i = 0; i < controls.size(); ++i) data.ctrl[controls[i]] = command.values[i];
}

void AppliedInputs::apply(const mjModel& model, mjData& data, const SetJointState& command) {
  const int joint = command.joint.id;
  double* qpos = data.qpos + model.jnt_qposadr[joint];
  std::copy(command.qpos.begin(), command.qpos.end(), qpos);
  if (command.qpos.size() >= 4) mju_normalize4(qpos + command.qpos.size() - 4);  // free, ball
  std::copy(command.qvel.begin(), command.qvel.end(), data.qvel + model.jnt_dofadr[joint]);
}

void AppliedInputs::apply(const mjModel& model, mjData& data, const SetMocapPose& command) {
  const int mocap = model.body_mocapid[command.body.id];
  const Vec3& p = command.X_WB.p;
  const Quat& q = command.X_WB.q;
  const double position[3] = {p.x, p.y, p.z};
  double rotation[4] = {q.w, q.x, q.y, q.z};
  mju_normalize4(rotation);
  mju_copy3(data.mocap_pos + 3 * mocap, position);
  mju_copy4(data.mocap_quat + 4 * mocap, rotation);
}

void AppliedInputs::apply(const mjModel&, mjData& data, const SetWrench& command) {
  const double values[6] = {command.force.x,  command.force.y,  command.force.z,
                            command.torque.x, command.torque.y, command.torque.z};
  mju_copy(wrench_.data() + 6 * command.body.id, values, 6);
  mju_copy(data.xfrc_applied + 6 * command.body.id, values, 6);
}

void AppliedInputs::apply(const mjModel& model, mjData& data, const AddVelocity& command) {
  // A free joint's linear velocity is that of the body's origin in world axes; adding to it moves
  // everything that hangs from the body alike.
  double* v = data.qvel + model.jnt_dofadr[floating_joint(model, command.body.id)];
  v[0] += command.velocity.x;
  v[1] += command.velocity.y;
  v[2] += command.velocity.z;
}

void AppliedInputs::apply(const mjModel&, mjData& data, const DragBody& command) {
  const int body = command.body.id;
  auto drag =
      std::find_if(drags_.begin(), drags_.end(), [body](const Drag& d) { return d.body == body; });
  if (!command.active) {
    if (drag == drags_.end()) return;
    mju_copy(data.xfrc_applied + 6 * body, wrench_.data() + 6 * body, 6);
    drags_.erase(drag);
    return;
  }
  const Vec3 &p = command.point_B, &t = command.target_W;
  const Drag next{body, {p.x, p.y, p.z}, {t.x, t.y, t.z}, 0};
  if (drag == drags_.end()) {
    drags_.push_back(next);
  } else {
    *drag = next;
  }
}

void AppliedInputs::before_step(const mjModel& model, mjData& data) {
  if (drags_.empty()) return;
  // The poses in mjData are those before the last step; the spring needs those of now.
  mj_kinematics(&model, &data);
  mj_comPos(&model, &data);
  for (Drag& drag : drags_) pull(model, data, drag);
}

// A critically damped spring of the model's perturbation stiffness per unit of mass
// (visual/map/stiffness [1/s²]), as MuJoCo's viewer pulls.
void AppliedInputs::pull(const mjModel& model, mjData& data, Drag& drag) {
  double point_W[3];
  mju_mulMatVec3(point_W, data.xmat + 9 * drag.body, drag.point_B);
  mju_addTo3(point_W, data.xpos + 3 * drag.body);
  const int nv = static_cast<int>(model.nv);
  mj_jac(&model, &data, jacobian_.data(), nullptr, point_W, drag.body);
  if (drag.mass == 0) {
    mj_makeM(&model, &data);
    mj_factorM(&model, &data);
    mj_solveM(&model, &data, solved_.data(), jacobian_.data(), 3);
    const double inverse_mass = mju_dot(solved_.data(), jacobian_.data(), 3 * nv) / 3;
    drag.mass = 1 / std::max(inverse_mass, mjMINVAL);
  }
  double velocity[3];
  mju_mulMatVec(velocity, jacobian_.data(), data.qvel, 3, nv);

  const double stiffness = model.vis.map.stiffness;
  double force[3], arm[3], torque[3];
  for (int i = 0; i < 3; ++i) {
    force[i] = drag.mass * (stiffness * (drag.target_W[i] - point_W[i]) -
                            2 * std::sqrt(stiffness) * velocity[i]);
  }
  mju_sub3(arm, point_W, data.xipos + 3 * drag.body);
  mju_cross(torque, arm, force);
  double* wrench = data.xfrc_applied + 6 * drag.body;
  mju_copy(wrench, wrench_.data() + 6 * drag.body, 6);
  mju_addTo3(wrench, force);
  mju_addTo3(wrench + 3, torque);
}

}  // namespace gloam
