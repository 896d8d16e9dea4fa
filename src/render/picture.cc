#include "render/picture.h"

#include <algorithm>

#include "render/scene/pose.h"

namespace gloam {
namespace {

/// Rotation as a unit quaternion wxyz.
CameraKey camera_key(const Affine3f& X) {
  const Quat q = quaternion_of(X);
  return {X.p,
          {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
           static_cast<float>(q.z)}};
}

Affine3f camera_pose(const CameraDescription& camera, const PoseFrame& frame) {
  if (camera.camera < 0) return camera.X_WC;
  const double* p = &frame.camera_p[3 * static_cast<size_t>(camera.camera)];
  const double* R = &frame.camera_R[9 * static_cast<size_t>(camera.camera)];
  const auto column = [R](int i) {
    return Vec3f{static_cast<float>(R[i]), static_cast<float>(R[3 + i]),
                 static_cast<float>(R[6 + i])};
  };
  return {column(0),
          column(1),
          column(2),
          {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}};
}

}  // namespace

CameraView32 make_camera(const CameraView& view, std::vector<CameraKey>* keys) {
  CameraView32 camera;
  camera.fx = static_cast<float>(view.intrinsics.fx);
  camera.fy = static_cast<float>(view.intrinsics.fy);
  camera.cx = static_cast<float>(view.intrinsics.cx);
  camera.cy = static_cast<float>(view.intrinsics.cy);
  camera.orthographic = view.intrinsics.orthographic;
  if (!view.intrinsics.orthographic) camera.lens = make_lens<float>(view.intrinsics);
  camera.shutter = view.shutter;
  camera.aperture = view.aperture;
  camera.pose = {view.X_WC_open, view.X_WC_previous, {}};
  keys->clear();
  for (const Affine3f& X_WC : view.X_WC_keys) keys->push_back(camera_key(X_WC));
  const bool moving = std::any_of(view.X_WC_keys.begin(), view.X_WC_keys.end(),
                                  [&](const Affine3f& X) { return !is_same(X, view.X_WC_open); });
  if (moving) camera.pose.keys = {keys->data(), static_cast<uint32_t>(keys->size())};
  return camera;
}

void resize_film(const CameraView& view, const RenderSettings& settings, Film* film) {
  film->width = view.intrinsics.width;
  film->height = view.intrinsics.height;
  const size_t n = film->pixel_count(), exact = settings.exact_channels ? n : 0;
  const size_t details = settings.exact_details ? exact : 0;
  const size_t light = settings.spp > 0 || settings.tier == RenderTier::kInteractive ? n : 0;
  const PictureFinish& finish = settings.finish;
  const size_t guides = finish.denoise || finish.to_display ? 0 : light;
  film->rgb.resize(finish.to_display ? 3 * light : 0);
  film->radiance.resize(finish.to_display ? 0 : light);
  film->albedo.resize(guides);
  film->normal.resize(guides);
  film->variance.resize(settings.variance ? light : 0);
  film->sample_count.resize(settings.error > 0 ? n : 0);
  visit_places([&](auto& plane) { plane.resize(exact); }, *film);
  visit_details([&](auto& plane) { plane.resize(details); }, *film);
}

PictureClip clip_of(const CameraView& view, const SceneView& scene, const CameraView32& camera) {
  PictureClip clip{scene, camera, {view.near, view.culls_backs, {}}};
  if (view.hidden != nullptr)
    clip.view.hidden = {view.hidden->data(), static_cast<uint32_t>(view.hidden->size())};
  return clip;
}

CameraView view_at(const RenderDescription& description, int camera,
                   std::span<const PoseFrame* const> keys, const PoseFrame& previous) {
  const CameraDescription& in = description.cameras[static_cast<size_t>(camera)];
  CameraView view{in.intrinsics, camera_pose(in, *keys.front()), camera_pose(in, previous)};
  view.near = in.near;
  view.culls_backs = in.culls_backs;
  view.hidden = in.hidden;
  if (keys.size() > 1) {
    for (const PoseFrame* key : keys) view.X_WC_keys.push_back(camera_pose(in, *key));
  }
  return view;
}

}  // namespace gloam
