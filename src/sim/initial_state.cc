#include "sim/initial_state.h"

#include <fmt/format.h>

#include "base/text.h"

namespace gloam {
namespace {

bool belongs_to(const mjModel& model, int body, int root) {
  while (body > root && body > 0) body = model.body_parentid[body];
  return body == root;
}

void copy_joint(const mjModel& model, mjData& data, int joint, int key, const Pose& X_WR) {
  const int type = model.jnt_type[joint];
  const int nq = type == mjJNT_FREE ? 7 : type == mjJNT_BALL ? 4 : 1;
  const int nv = type == mjJNT_FREE ? 6 : type == mjJNT_BALL ? 3 : 1;
  double* qpos = data.qpos + model.jnt_qposadr[joint];
  double* qvel = data.qvel + model.jnt_dofadr[joint];
  mju_copy(qpos, model.key_qpos + key * model.nq + model.jnt_qposadr[joint], nq);
  mju_copy(qvel, model.key_qvel + key * model.nv + model.jnt_dofadr[joint], nv);
  if (type != mjJNT_FREE) return;
  // Keyframes are written in the robot's own file: its world is the frame R here.
  const double p_WR[3] = {X_WR.p.x, X_WR.p.y, X_WR.p.z};
  const double q_WR[4] = {X_WR.q.w, X_WR.q.x, X_WR.q.y, X_WR.q.z};
  const double p_RB[3] = {qpos[0], qpos[1], qpos[2]};
  const double q_RB[4] = {qpos[3], qpos[4], qpos[5], qpos[6]};
  const double v_R[3] = {qvel[0], qvel[1], qvel[2]};
  mju_mulPose(qpos, qpos + 3, p_WR, q_WR, p_RB, q_RB);
  mju_rotVecQuat(qvel, v_R, q_WR);
}

// The body an actuator drives, by its transmission; -1 when that is no single body.
int driven_body(const mjModel& model, int actuator) {
  const int target = model.actuator_trnid[2 * actuator];
  switch (model.actuator_trntype[actuator]) {
    case mjTRN_JOINT:
    case mjTRN_JOINTINPARENT:
      return model.jnt_bodyid[target];
    case mjTRN_SITE:
    case mjTRN_SLIDERCRANK:
    case mjTRN_SO3:
      return model.site_bodyid[target];
    case mjTRN_BODY:
      return target;
    case mjTRN_TENDON: {
      const int wrap = model.tendon_adr[target];
      const int object = model.wrap_objid[wrap];
      if (model.wrap_type[wrap] == mjWRAP_JOINT) return model.jnt_bodyid[object];
      if (model.wrap_type[wrap] == mjWRAP_SITE) return model.site_bodyid[object];
      return -1;
    }
    default:
      return -1;
  }
}

void copy_robot(const mjModel& model, mjData& data, const RobotInstance& robot, int key) {
  const Pose& X_WR = robot.options.X_WR;
  for (int joint = 0; joint < model.njnt; ++joint) {
    if (belongs_to(model, model.jnt_bodyid[joint], robot.root_body)) {
      copy_joint(model, data, joint, key, X_WR);
    }
  }
  for (int actuator = 0; actuator < model.nactuator; ++actuator) {
    const int body = driven_body(model, actuator);
    if (body < 0 || !belongs_to(model, body, robot.root_body)) continue;
    const int ctrl = model.actuator_ctrladr[actuator], act = model.actuator_actadr[actuator];
    mju_copy(data.ctrl + ctrl, model.key_ctrl + key * model.nu + ctrl,
             model.actuator_ctrlnum[actuator]);
    if (act >= 0) {
      mju_copy(data.act + act, model.key_act + key * model.na + act,
               model.actuator_actnum[actuator]);
    }
  }
}

}  // namespace

Result<std::vector<int>> find_keyframes(const CompiledWorld& world) {
  const mjModel& model = *world.model;
  std::vector<int> keyframes;
  for (const RobotInstance& robot : world.robots) {
    const std::string& wanted = robot.options.keyframe;
    keyframes.push_back(
        wanted.empty() ? -1 : mj_name2id(&model, mjOBJ_KEY, (robot.prefix + wanted).c_str()));
    if (wanted.empty() || keyframes.back() >= 0) continue;
    std::vector<std::string> names;
    for (int key = 0; key < model.nkey; ++key) {
      const char* name = mj_id2name(&model, mjOBJ_KEY, key);
      if (name == nullptr || !std::string_view(name).starts_with(robot.prefix)) continue;
      names.emplace_back(name + robot.prefix.size());
    }
    return Error{ErrorKind::kInput,
                 fmt::format("robot '{}' has no keyframe '{}'", robot.name, wanted),
                 robot.options.loc, suggest_name(wanted, names)};
  }
  return keyframes;
}

void reset_to_initial_state(const CompiledWorld& world, std::span<const int> keyframes,
                            const mjModel& model, mjData& data) {
  mj_resetData(&model, &data);
  for (size_t i = 0; i < keyframes.size(); ++i) {
    if (keyframes[i] < 0) continue;
    if (world.robots[i].prefix.empty()) {
      mj_resetDataKeyframe(&model, &data, keyframes[i]);
    } else {
      copy_robot(model, data, world.robots[i], keyframes[i]);
    }
  }
}

}  // namespace gloam
