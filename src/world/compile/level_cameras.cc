#include "world/compile/level_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "base/text.h"
#include "places/writer/spec_edit.h"
#include "world/compile/look_at.h"
#include "world/model_memory.h"
#include "world/sensors/mount.h"
#include "world/world.h"

namespace gloam {
namespace {

Quat orientation_of(const CameraOptions& camera) {
  if (camera.orientation) return *camera.orientation;
  return camera.look_at ? look_at(camera.position, *camera.look_at) : Quat{};
}

bool says_nothing_of_its_pose(const CameraOptions& camera) {
  return camera.body.empty() && camera.track.empty() && !camera.look_at && !camera.orientation &&
         camera.position == Vec3{};
}

std::vector<std::string> spec_names(const mjSpec* spec, mjtObj type) {
  std::vector<std::string> names;
  for (mjsElement* e = mjs_firstElement(spec, type); e != nullptr; e = mjs_nextElement(spec, e)) {
    const char* name = mjs_getString(mjs_getName(e));
    if (*name != 0) names.emplace_back(name);
  }
  return names;
}

std::vector<std::string> mount_names(const mjSpec* spec) {
  std::vector<std::string> names = spec_names(spec, mjOBJ_BODY);
  for (std::string& site : spec_names(spec, mjOBJ_SITE)) names.push_back(std::move(site));
  return names;
}

void set_pose(mjsCamera* out, const double p[3], const double q[4]) {
  std::copy(p, p + 3, out->pos);
  std::copy(q, q + 4, out->quat);
}

// The body that a camera follows, or the body or site to which it is fixed.
Result<std::optional<SpecMount>> camera_mount(const CameraOptions& camera, mjSpec* spec) {
  if (!camera.track.empty()) {
    mjsBody* body = mjs_findBody(spec, camera.track.c_str());
    return body == nullptr ? std::optional<SpecMount>() : std::optional(SpecMount{.body = body});
  }
  Result<std::optional<SpecMount>> mount = find_mount(spec, camera.body);
  if (mount.ok()) return mount;
  Error error = mount.error();
  error.message = fmt::format("camera '{}': {}", camera.name, error.message);
  error.loc = camera.loc;
  return error;
}

}  // namespace

Status add_cameras(const Scene& scene, Level* level) {
  mjSpec* spec = level->spec.get();
  for (const CameraOptions& camera : scene.cameras) {
    if (mjs_findElement(spec, mjOBJ_CAMERA, camera.name.c_str()) != nullptr) {
      if (says_nothing_of_its_pose(camera)) continue;
      return Error{ErrorKind::kInput,
                   fmt::format("a model already has a camera named '{}'", camera.name), camera.loc,
                   "choose another name, or omit the pose to use the model's camera"};
    }
    const std::string& name = camera.track.empty() ? camera.body : camera.track;
    GLOAM_TRY(const std::optional<SpecMount> mount, camera_mount(camera, spec));
    if (!mount) {
      return Error{ErrorKind::kInput,
                   fmt::format("camera '{}': there is no body or site '{}'", camera.name, name),
                   camera.loc, suggest_name(name, mount_names(spec))};
    }
    mjsCamera* out = edit(mjs_addCamera, mount->body, nullptr);
    if (mount->frame != nullptr) edit(mjs_setFrame, out->element, mount->frame);
    edit(mjs_setName, out->element, camera.name.c_str());
    // A body's frame leaves the numbers as they are, to the last bit.
    const Pose X_MC{camera.position, orientation_of(camera)};
    const auto [p, q] = mount->X_FM == Pose{} ? X_MC : compose(mount->X_FM, X_MC);
    const double position[3] = {p.x, p.y, p.z};
    const double quat[4] = {q.w, q.x, q.y, q.z};
    set_pose(out, position, quat);
    if (!camera.track.empty()) out->mode = mjCAMLIGHT_TRACK;
    out->fovy = camera.fovy;
    out->resolution[0] = camera.width;
    out->resolution[1] = camera.height;
  }
  return {};
}

bool turn_tracking_cameras(const Scene& scene, Level* level) {
  const bool any = std::any_of(scene.cameras.begin(), scene.cameras.end(),
                               [](const CameraOptions& c) { return !c.track.empty(); });
  if (!any) return false;
  const mjModel* model = level->model.get();
  const DataPtr data = make_data(*model);
  mj_kinematics(model, data.get());  // at qpos0, where MuJoCo measures tracking offsets
  bool changed = false;
  for (const CameraOptions& camera : scene.cameras) {
    const int body =
        camera.track.empty() ? -1 : mj_name2id(model, mjOBJ_BODY, camera.track.c_str());
    if (body < 0) continue;
    const double* q_WB = data->xquat + 4 * body;
    const double identity[4] = {1, 0, 0, 0};
    if (std::equal(q_WB, q_WB + 4, identity)) continue;
    double q_BW[4], p_B[3], q_B[4];
    mju_negQuat(q_BW, q_WB);
    const Quat q = orientation_of(camera);
    const double position[3] = {camera.position.x, camera.position.y, camera.position.z};
    const double quat[4] = {q.w, q.x, q.y, q.z};
    mju_rotVecQuat(p_B, position, q_BW);
    mju_mulQuat(q_B, q_BW, quat);
    mjsElement* element = mjs_findElement(level->spec.get(), mjOBJ_CAMERA, camera.name.c_str());
    set_pose(mjs_asCamera(element), p_B, q_B);
    changed = true;
  }
  return changed;
}

}  // namespace gloam
