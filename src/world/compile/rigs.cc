#include "world/compile/rigs.h"

#include <fmt/format.h>

#include "world/compile/look_at.h"

namespace gloam {
namespace {

// First column of the rotation matrix.
Vec3 x_axis(const Quat& q) {
  return {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.w * q.z),
          2 * (q.x * q.z - q.w * q.y)};
}

CameraOptions rig_camera(const RigOptions& rig, const char* part, double offset,
                         const CameraSensing& sensing, const SourceLoc& loc) {
  CameraOptions camera;
  camera.name = fmt::format("{}/{}", rig.name, part);
  camera.body = rig.body;
  camera.orientation = rig.orientation ? *rig.orientation
                       : rig.look_at   ? look_at(rig.position, *rig.look_at)
                                       : Quat{};
  const Vec3 x = x_axis(*camera.orientation);
  camera.position = {rig.position.x + offset * x.x, rig.position.y + offset * x.y,
                     rig.position.z + offset * x.z};
  camera.fovy = rig.fovy;
  camera.width = rig.width;
  camera.height = rig.height;
  camera.rate = rig.rate;
  camera.sensing = sensing;
  camera.loc = loc;
  return camera;
}

Status add(CameraOptions camera, Scene* scene) {
  for (const CameraOptions& other : scene->cameras) {
    if (other.name == camera.name)
      return Error{ErrorKind::kInput,
                   fmt::format("camera '{}' has the same name as a camera of the rig", camera.name),
                   camera.loc, "rename one of them"};
  }
  scene->cameras.push_back(std::move(camera));
  return {};
}

}  // namespace

Result<Scene> with_rig_cameras(const Scene& scene) {
  Scene out = scene;
  out.stereo.clear();
  out.rgbd.clear();
  for (const StereoOptions& rig : scene.stereo) {
    GLOAM_TRY_STATUS(add(rig_camera(rig, "left", 0, rig.sensing, rig.loc), &out));
    GLOAM_TRY_STATUS(add(rig_camera(rig, "right", rig.baseline, rig.sensing, rig.loc), &out));
  }
  for (const RgbdOptions& rig : scene.rgbd) {
    CameraSensing depth;
    depth.timing = rig.sensing.timing;
    depth.stereo_depth = rig.depth;
    GLOAM_TRY_STATUS(add(rig_camera(rig, "depth", 0, depth, rig.loc), &out));
    CameraOptions color = rig_camera(rig, "color", rig.color_offset, rig.sensing, rig.loc);
    color.fovy = rig.color_fovy.value_or(rig.fovy);
    GLOAM_TRY_STATUS(add(std::move(color), &out));
  }
  return out;
}

}  // namespace gloam
