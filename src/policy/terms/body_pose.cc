#include "policy/terms/body_pose.h"

#include <fmt/format.h>

#include "base/text.h"

namespace gloam {

std::string full_name(const RobotInstance& robot, const std::string& name) {
  return name.starts_with(robot.prefix) ? name : robot.prefix + name;
}

std::vector<std::string> names_of(const mjModel& model, const RobotInstance& robot, mjtObj type) {
  std::vector<std::string> names;
  const auto count = [&]() -> int {
    switch (type) {
      case mjOBJ_BODY:
        return static_cast<int>(model.nbody);
      case mjOBJ_JOINT:
        return static_cast<int>(model.njnt);
      case mjOBJ_GEOM:
        return static_cast<int>(model.ngeom);
      case mjOBJ_CAMERA:
        return static_cast<int>(model.ncam);
      case mjOBJ_SENSOR:
        return static_cast<int>(model.nsensor);
      default:
        return 0;
    }
  }();
  for (int i = 0; i < count; ++i) {
    const char* name = mj_id2name(&model, type, i);
    if (name != nullptr && std::string_view(name).starts_with(robot.prefix))
      names.emplace_back(name);
  }
  return names;
}

Result<int> find_body(const TermBinding& binding, const std::string& name) {
  if (name.empty()) return binding.robot->root_body;
  const std::string full = full_name(*binding.robot, name);
  const int body = mj_name2id(binding.model, mjOBJ_BODY, full.c_str());
  if (body >= 0) return body;
  return Error{ErrorKind::kInput,
               fmt::format("robot '{}' has no body '{:.80}', which the policy requires",
                           binding.robot->name, full),
               {},
               suggest_name(full, names_of(*binding.model, *binding.robot, mjOBJ_BODY))};
}

void body_orientation(const mjModel& m, const mjData& d, int body, mjtNum q_WB[4]) {
  mjtNum q[4] = {1, 0, 0, 0};  // of `body` in the frame of the body reached so far
  for (; body > 0; body = m.body_parentid[body]) {
    mjtNum local[4], product[4];
    mju_copy4(local, m.body_quat + 4 * body);
    for (int j = 0; j < m.body_jntnum[body]; ++j) {
      const int joint = m.body_jntadr[body] + j;
      const mjtNum* qpos = d.qpos + m.jnt_qposadr[joint];
      mjtNum turn[4] = {1, 0, 0, 0};
      if (m.jnt_type[joint] == mjJNT_FREE) {
        mju_copy4(local, qpos + 3);
      } else if (m.jnt_type[joint] == mjJNT_BALL) {
        mju_copy4(turn, qpos);
      } else if (m.jnt_type[joint] == mjJNT_HINGE) {
        mju_axisAngle2Quat(turn, m.jnt_axis + 3 * joint, qpos[0] - m.qpos0[m.jnt_qposadr[joint]]);
      }
      mju_mulQuat(product, local, turn);
      mju_copy4(local, product);
    }
    mju_mulQuat(product, local, q);
    mju_copy4(q, product);
  }
  mju_normalize4(q);
  mju_copy4(q_WB, q);
}

}  // namespace gloam
