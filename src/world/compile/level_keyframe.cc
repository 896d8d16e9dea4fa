#include "world/compile/level_keyframe.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/check.h"
#include "base/text.h"
#include "places/writer/spec_edit.h"

namespace gloam {
namespace {

// Elements that came with the robot: of its own file, or of a model attached there, whose
// elements remember that model's spec instead and are known by their names or their bodies'.
template <class F>
void each_element_of(const mjSpec* level, const LevelRobot& robot, mjtObj type, F&& f) {
  const std::string prefix = robot.options.name + "/";
  const auto is_own = [&](mjsElement* e) {
    return mjs_getOriginSpec(e) == robot.spec.get() ||
           std::string_view(mjs_getString(mjs_getName(e))).starts_with(prefix);
  };
  for (mjsElement* e = mjs_firstElement(level, type); e != nullptr; e = mjs_nextElement(level, e)) {
    bool belongs = is_own(e);
    for (mjsBody* body = mjs_getParent(e); body != nullptr && !belongs;
         body = mjs_getParent(body->element))
      belongs = is_own(body->element);
    if (belongs) f(mjs_getId(e));
  }
}

// X_WR applied to a pose given in the robot's root frame, in place.
void move_pose(const Pose& X_WR, double* p, double* q) {
  const double q_WR[4] = {X_WR.q.w, X_WR.q.x, X_WR.q.y, X_WR.q.z};
  double p_W[3], q_W[4];
  mju_rotVecQuat(p_W, p, q_WR);
  mju_mulQuat(q_W, q_WR, q);
  p[0] = p_W[0] + X_WR.p.x;
  p[1] = p_W[1] + X_WR.p.y;
  p[2] = p_W[2] + X_WR.p.z;
  std::copy(q_W, q_W + 4, q);
}

void rotate(const Quat& q_WR, double* v) {
  const double q[4] = {q_WR.w, q_WR.x, q_WR.y, q_WR.z};
  double out[3];
  mju_rotVecQuat(out, v, q);
  std::copy(out, out + 3, v);
}

int joint_nq(int type) { return type == mjJNT_FREE ? 7 : type == mjJNT_BALL ? 4 : 1; }
int joint_nv(int type) { return type == mjJNT_FREE ? 6 : type == mjJNT_BALL ? 3 : 1; }

/// The vectors of one keyframe, as views into the model.
struct KeyVectors {
  mjtNum *qpos, *qvel, *act, *mpos, *mquat, *ctrl;
  KeyVectors(mjModel* m, int key)
      : qpos(m->key_qpos + key * m->nq),
        qvel(m->key_qvel + key * m->nv),
        act(m->key_act + key * m->na),
        mpos(m->key_mpos + key * 3 * m->nmocap),
        mquat(m->key_mquat + key * 4 * m->nmocap),
        ctrl(m->key_ctrl + key * m->nu) {}
};

void copy_robot(const mjSpec* level, const LevelRobot& robot, mjModel* m, const KeyVectors& from,
                const KeyVectors& to) {
  const Pose& X_WR = robot.options.X_WR;
  std::vector<bool> owns_joint(static_cast<size_t>(m->njnt));
  each_element_of(level, robot, mjOBJ_JOINT, [&](int joint) {
    owns_joint[static_cast<size_t>(joint)] = true;
    const int type = m->jnt_type[joint], q = m->jnt_qposadr[joint], v = m->jnt_dofadr[joint];
    std::copy_n(from.qpos + q, joint_nq(type), to.qpos + q);
    std::copy_n(from.qvel + v, joint_nv(type), to.qvel + v);
    if (type == mjJNT_FREE) {
      move_pose(X_WR, to.qpos + q, to.qpos + q + 3);
      rotate(X_WR.q, to.qvel + v);  // linear part: world axes; the angular part is in the body's
    }
  });
  std::vector<bool> owns_actuator(static_cast<size_t>(m->nactuator));
  each_element_of(level, robot, mjOBJ_ACTUATOR,
                  [&](int actuator) { owns_actuator[static_cast<size_t>(actuator)] = true; });
  for (int actuator = 0; actuator < static_cast<int>(m->nactuator); ++actuator) {
    // Those of attached models that have no name are known by the joint that they drive.
    const int type = m->actuator_trntype[actuator], target = m->actuator_trnid[2 * actuator];
    const bool drives = (type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT) && target >= 0 &&
                        owns_joint[static_cast<size_t>(target)];
    if (!owns_actuator[static_cast<size_t>(actuator)] && !drives) continue;
    const int ctrl = m->actuator_ctrladr[actuator], act = m->actuator_actadr[actuator];
    if (ctrl >= 0) std::copy_n(from.ctrl + ctrl, m->actuator_ctrlnum[actuator], to.ctrl + ctrl);
    if (act >= 0) std::copy_n(from.act + act, m->actuator_actnum[actuator], to.act + act);
  }
  each_element_of(level, robot, mjOBJ_BODY, [&](int body) {
    const int mocap = m->body_mocapid[body];
    if (mocap < 0) return;
    std::copy_n(from.mpos + 3 * mocap, 3, to.mpos + 3 * mocap);
    std::copy_n(from.mquat + 4 * mocap, 4, to.mquat + 4 * mocap);
    move_pose(X_WR, to.mpos + 3 * mocap, to.mquat + 4 * mocap);
  });
}

}  // namespace

void add_initial_keyframe(const Scene& scene, Level* level) {
  const bool wanted = std::any_of(scene.robots.begin(), scene.robots.end(),
                                  [](const RobotOptions& r) { return !r.keyframe.empty(); });
  if (!wanted) return;
  std::string name = "initial";
  while (mjs_findElement(level->spec.get(), mjOBJ_KEY, name.c_str()) != nullptr) name += "_";
  edit(mjs_setName, edit(mjs_addKey, level->spec.get())->element, name.c_str());
  level->initial_key = 0;  // its place is known once the model is compiled
}

Status fill_initial_keyframe(Level* level) {
  if (level->initial_key < 0) return {};
  mjModel* m = level->model.get();
  std::string name = "initial";
  while (mj_name2id(m, mjOBJ_KEY, (name + "_").c_str()) >= 0) name += "_";
  level->initial_key = mj_name2id(m, mjOBJ_KEY, name.c_str());
  const KeyVectors initial(m, level->initial_key);
  for (const LevelRobot& robot : level->robots) {
    if (robot.options.keyframe.empty()) continue;
    const std::string prefix = robot.options.name + "/";
    const int key = mj_name2id(m, mjOBJ_KEY, (prefix + robot.options.keyframe).c_str());
    if (key < 0) {
      std::vector<std::string> names;
      for (const std::string& full : object_names(m, mjOBJ_KEY)) {
        if (full.starts_with(prefix)) names.push_back(full.substr(prefix.size()));
      }
      return Error{ErrorKind::kInput,
                   fmt::format("robot '{}' has no keyframe '{}'", robot.options.name,
                               robot.options.keyframe),
                   robot.options.loc,
                   names.empty() ? "its model has no named keyframes"
                                 : suggest_name(robot.options.keyframe, names)};
    }
    copy_robot(level->spec.get(), robot, m, KeyVectors(m, key), initial);
  }
  mjsKey* spec_key = nullptr;
  for (mjsElement* e = mjs_firstElement(level->spec.get(), mjOBJ_KEY); e != nullptr;
       e = mjs_nextElement(level->spec.get(), e)) {
    if (name == mjs_getString(mjs_getName(e))) spec_key = mjs_asKey(e);
  }
  GLOAM_CHECK(spec_key != nullptr, "the model has a keyframe that its spec does not have");
  edit(mjs_setDouble, spec_key->qpos, initial.qpos, static_cast<int>(m->nq));
  edit(mjs_setDouble, spec_key->qvel, initial.qvel, static_cast<int>(m->nv));
  edit(mjs_setDouble, spec_key->act, initial.act, static_cast<int>(m->na));
  edit(mjs_setDouble, spec_key->ctrl, initial.ctrl, static_cast<int>(m->nu));
  edit(mjs_setDouble, spec_key->mpos, initial.mpos, static_cast<int>(3 * m->nmocap));
  edit(mjs_setDouble, spec_key->mquat, initial.mquat, static_cast<int>(4 * m->nmocap));
  return {};
}

}  // namespace gloam
