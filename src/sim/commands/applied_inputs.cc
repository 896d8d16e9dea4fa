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
  turns_.reserve(static_cast<size_t>(model.nbody));
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
    for (Turn turn : before.turns_) {
      if (turn.body != old) continue;
      turn.body = static_cast<int>(body);
      turns_.push_back(turn);
    }
  }
  joints_.take_over(before.joints_, same);
}

void AppliedInputs::reset() {
  std::fill(wrench_.begin(), wrench_.end(), 0.0);
  drags_.clear();
  turns_.clear();
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

void AppliedInputs::set_base_wrench(mjData& data, int body) const {
  mju_copy(data.xfrc_applied + 6 * body, wrench_.data() + 6 * body, 6);
}

void AppliedInputs::apply(const mjModel&, mjData& data, const DragBody& command) {
  const int body = command.body.id;
  auto drag = std::ranges::find(drags_, body, &Drag::body);
  if (!command.active) {
    if (drag == drags_.end()) return;
    set_base_wrench(data, body);
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

void AppliedInputs::apply(const mjModel&, mjData& data, const TurnBody& command) {
  const int body = command.body.id;
  auto turn = std::ranges::find(turns_, body, &Turn::body);
  if (!command.active) {
    if (turn == turns_.end()) return;
    set_base_wrench(data, body);
    turns_.erase(turn);
    return;
  }
  const Quat& q = command.target_WB;
  Turn next{body, {q.w, q.x, q.y, q.z}, 0};
  mju_normalize4(next.target_WB);
  if (turn == turns_.end()) {
    turns_.push_back(next);
  } else {
    *turn = next;
  }
}

void AppliedInputs::apply(const mjModel&, mjData& data, const SetEquality& command) {
  data.eq_active[command.equality.id] = command.active;
}

void AppliedInputs::before_step(const mjModel& model, mjData& data) {
  if (drags_.empty() && turns_.empty()) return;
  // The poses in mjData are those before the last step; the spring needs those of now.
  mj_kinematics(&model, &data);
  mj_comPos(&model, &data);
  for (const Drag& drag : drags_) set_base_wrench(data, drag.body);
  for (const Turn& turn : turns_) set_base_wrench(data, turn.body);
  for (Drag& drag : drags_) pull(model, data, drag);
  for (Turn& turn : turns_) this->turn(model, data, turn);
}

// Inverse of the mean acceleration that a unit of force, or of torque, causes along the rows of
// jacobian_.
double AppliedInputs::mean_inertia(const mjModel& model, mjData& data) {
  mj_makeM(&model, &data);
  mj_factorM(&model, &data);
  mj_solveM(&model, &data, solved_.data(), jacobian_.data(), 3);
  const int size = 3 * static_cast<int>(model.nv);
  return 1 / std::max(mju_dot(solved_.data(), jacobian_.data(), size) / 3, mjMINVAL);
}

// A critically damped spring of the model's perturbation stiffness per unit of mass
// (visual/map/stiffness [1/s²]), as MuJoCo's viewer pulls.
void AppliedInputs::pull(const mjModel& model, mjData& data, Drag& drag) {
  double point_W[3];
  mju_mulMatVec3(point_W, data.xmat + 9 * drag.body, drag.point_B);
  mju_addTo3(point_W, data.xpos + 3 * drag.body);
  const int nv = static_cast<int>(model.nv);
  mj_jac(&model, &data, jacobian_.data(), nullptr, point_W, drag.body);
  if (drag.mass == 0) drag.mass = mean_inertia(model, data);
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
  mju_addTo3(wrench, force);
  mju_addTo3(wrench + 3, torque);
}

// The same for the orientation (visual/map/stiffnessrot [1/s²]).
void AppliedInputs::turn(const mjModel& model, mjData& data, Turn& turn) {
  const int nv = static_cast<int>(model.nv);
  mj_jac(&model, &data, nullptr, jacobian_.data(), data.xpos + 3 * turn.body, turn.body);
  if (turn.inertia == 0) turn.inertia = mean_inertia(model, data);
  double inverse[4], difference[4], error[3], velocity[3];
  mju_negQuat(inverse, data.xquat + 4 * turn.body);
  mju_mulQuat(difference, turn.target_WB, inverse);
  mju_quat2Vel(error, difference, 1);
  mju_mulMatVec(velocity, jacobian_.data(), data.qvel, 3, nv);
  const double stiffness = model.vis.map.stiffnessrot;
  double* torque = data.xfrc_applied + 6 * turn.body + 3;
  for (int i = 0; i < 3; ++i)
    torque[i] += turn.inertia * (stiffness * error[i] - 2 * std::sqrt(stiffness) * velocity[i]);
}

}  // namespace gloam
