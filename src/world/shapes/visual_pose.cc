#include "world/shapes/visual_pose.h"

#include "world/model_memory.h"

namespace gloam {

Affine3f rigid_pose(const mjtNum* position, const mjtNum* quaternion) {
  mjtNum r[9];
  mju_quat2Mat(r, quaternion);
  const auto f = [](mjtNum x) { return static_cast<float>(x); };
  return {{f(r[0]), f(r[3]), f(r[6])},
          {f(r[1]), f(r[4]), f(r[7])},
          {f(r[2]), f(r[5]), f(r[8])},
          {f(position[0]), f(position[1]), f(position[2])}};
}

std::vector<Affine3f> body_poses_at_qpos0(const mjModel& model) {
  std::vector<Affine3f> poses(static_cast<size_t>(model.nbody));
  for (size_t b = 1; b < poses.size(); ++b)
    poses[b] = poses[static_cast<size_t>(model.body_parentid[b])] *
               rigid_pose(model.body_pos + 3 * b, model.body_quat + 4 * b);
  return poses;
}

std::vector<Affine3f> body_poses_at_start(const CompiledWorld& world) {
  const mjModel& m = *world.model;
  if (world.initial_key < 0) return body_poses_at_qpos0(m);
  const DataPtr data = make_data(m);
  mj_resetDataKeyframe(&m, data.get(), world.initial_key);
  mj_kinematics(&m, data.get());
  std::vector<Affine3f> poses;
  for (int b = 0; b < static_cast<int>(m.nbody); ++b)
    poses.push_back(rigid_pose(data->xpos + 3 * b, data->xquat + 4 * b));
  return poses;
}

}  // namespace gloam
