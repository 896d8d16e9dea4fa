#include "runtime/rendering/pick.h"

#include <mutex>

#include "geometry/lens.h"
#include "geometry/mesh/single.h"
#include "sensors/camera/camera_sensor.h"

namespace gloam {

Result<PickResult> pick_at(SharedRenderer& shared, const PoseFrame& poses, const CameraFrame& frame,
                           double u, double v) {
  const std::lock_guard lock(shared.turns);
  // A picture of one pixel whose centre is (u, v).
  CameraView view;
  view.X_WC_open = view.X_WC_previous =
      to_affine(from_origin(frame.X_WC, shared.description.origin));
  view.intrinsics = frame.intrinsics;
  view.intrinsics.width = view.intrinsics.height = 1;
  view.intrinsics.cx = frame.intrinsics.cx - u + 0.5;
  view.intrinsics.cy = frame.intrinsics.cy - v + 0.5;
  shared.renderer->update(poses, poses, poses);
  Film film;
  RenderSettings settings;
  settings.spp = 0;
  shared.renderer->render(view, settings, &film);
  const uint32_t part = film.part.empty() ? 0 : film.part[0];
  const std::optional<PixelRay> ray = pixel_ray(frame.intrinsics, u, v);
  if (part == 0 || !ray) return Error{ErrorKind::kInput, "there is nothing under this pixel"};
  const Vec3f p_C = to_vec3f(ray->at(static_cast<double>(film.distance[0])));
  const Vec3f p_W = transform_point(view.X_WC_open, p_C);
  const InstanceDescription& instance = shared.description.instances[part - 1];
  const auto body = static_cast<size_t>(instance.body);
  const double* R = poses.body_R.data() + 9 * body;
  const double* p = poses.body_p.data() + 3 * body;
  const double d[3] = {p_W.x - p[0], p_W.y - p[1], p_W.z - p[2]};
  PickResult result;
  result.body = {instance.body, shared.world->serial};
  result.name = instance.label.body.empty() ? instance.label.instance_name : instance.label.body;
  result.point_W = in_world(Vec3{p_W.x, p_W.y, p_W.z}, shared.description.origin);
  result.point_B = {R[0] * d[0] + R[3] * d[1] + R[6] * d[2],
                    R[1] * d[0] + R[4] * d[1] + R[7] * d[2],
                    R[2] * d[0] + R[5] * d[1] + R[8] * d[2]};
  return result;
}

}  // namespace gloam
