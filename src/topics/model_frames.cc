#include "topics/model_frames.h"

#include <fmt/format.h>

#include "world/model_names.h"

namespace gloam {
namespace {

struct Numbers {
  mjtNum p[3], q[4];
  explicit Numbers(const Pose& X) : p{X.p.x, X.p.y, X.p.z}, q{X.q.w, X.q.x, X.q.y, X.q.z} {}
};
Pose pose_from(const mjtNum* p, const mjtNum* q) {
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
}

}  // namespace

std::string body_frame(const mjModel& model, int body) {
  if (body == 0) return "world";
  const std::string name = name_of(model, mjOBJ_BODY, body);
  return name.empty() ? fmt::format("body_{}", body) : name;
}

bool moves_in_parent(const mjModel& model, int body) {
  return model.body_dofnum[body] > 0 || model.body_mocapid[body] >= 0;
}

std::string joint_label(const mjModel& model, int joint, const std::string& prefix) {
  const std::string name = local_name(name_of(model, mjOBJ_JOINT, joint), prefix);
  return name.empty() ? fmt::format("joint_{}", joint) : name;
}

std::string local_name(const std::string& name, const std::string& prefix) {
  return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
}

Pose product(const Pose& X_AB, const Pose& X_BC) {
  const Numbers a(X_AB), b(X_BC);
  mjtNum p[3], q[4];
  mju_mulPose(p, q, a.p, a.q, b.p, b.q);
  return pose_from(p, q);
}

Pose inverse(const Pose& X_AB) {
  const Numbers a(X_AB);
  mjtNum p[3], q[4];
  mju_negPose(p, q, a.p, a.q);
  return pose_from(p, q);
}

Vec3 rotate_back(const Quat& q, const Vec3& v) {
  const mjtNum from[3] = {v.x, v.y, v.z}, back[4] = {q.w, -q.x, -q.y, -q.z};
  mjtNum out[3];
  mju_rotVecQuat(out, from, back);
  return {out[0], out[1], out[2]};
}

}  // namespace gloam
