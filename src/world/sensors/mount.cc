#include "world/sensors/mount.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

Pose as_pose(const double* p, const double* q) {
  return {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
}

}  // namespace

Result<std::optional<SpecMount>> find_mount(mjSpec* spec, const std::string& name) {
  if (mjsBody* body = mjs_findBody(spec, name.empty() ? "world" : name.c_str()))
    return std::optional(SpecMount{.body = body});
  mjsElement* element = mjs_findElement(spec, mjOBJ_SITE, name.c_str());
  if (element == nullptr) return std::optional<SpecMount>();
  const mjsSite* site = mjs_asSite(element);
  const mjsCompiler* compiler = mjs_getCompiler(element);
  double q[4];
  std::copy_n(site->quat, 4, q);
  const char* fault = nullptr;
  if (!std::isnan(site->fromto[0]))
    fault = "it is given by 'fromto'";
  else if (site->alt.type != mjORIENTATION_QUAT)
    fault = mjs_resolveOrientation(q, compiler->degree, compiler->eulerseq, &site->alt);
  if (fault != nullptr)
    return Error{ErrorKind::kUnsupported,
                 fmt::format("the site '{}' cannot hold a sensor: {}", name, fault),
                 {},
                 "give the site a 'pos' and a 'quat'"};
  mju_normalize4(q);
  return std::optional(
      SpecMount{mjs_getParent(element), mjs_getFrame(element), as_pose(site->pos, q)});
}

std::optional<ModelMount> find_mount(const mjModel& model, const std::string& name) {
  const int body = name.empty() ? 0 : mj_name2id(&model, mjOBJ_BODY, name.c_str());
  if (body >= 0) return ModelMount{.body = body};
  const int site = mj_name2id(&model, mjOBJ_SITE, name.c_str());
  if (site < 0) return {};
  return ModelMount{model.site_bodyid[site],
                    as_pose(model.site_pos + 3 * site, model.site_quat + 4 * site)};
}

Pose compose(const Pose& X_AB, const Pose& X_BC) {
  const double p_AB[3] = {X_AB.p.x, X_AB.p.y, X_AB.p.z}, p_BC[3] = {X_BC.p.x, X_BC.p.y, X_BC.p.z};
  const double q_AB[4] = {X_AB.q.w, X_AB.q.x, X_AB.q.y, X_AB.q.z};
  const double q_BC[4] = {X_BC.q.w, X_BC.q.x, X_BC.q.y, X_BC.q.z};
  double p[3], q[4];
  mju_mulPose(p, q, p_AB, q_AB, p_BC, q_BC);
  return as_pose(p, q);
}

}  // namespace gloam
