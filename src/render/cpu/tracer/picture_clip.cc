#include "render/cpu/tracer/picture_clip.h"

#include <cmath>

namespace gloam {

MaskLanes PictureClip::from_camera(const RayOf<FloatLanes>& ray, MaskLanes active) const {
  if (!camera.orthographic && !camera.has_aperture() && camera.pose.keys.empty()) {
    const Vec3f p = camera.pose.X_WC_open.p;
    return active & (ray.o.x == p.x) & (ray.o.y == p.y) & (ray.o.z == p.z);
  }
  MaskLanes begins = false;
  each_lane(active, [&](int i) {
    const Affine3f X_WC = camera_pose_at(camera.pose, lane(ray.time, i));
    const Vec3f away = lane(ray.o, i) - X_WC.p;
    const float size = max_component(Vec3f{fabsf(X_WC.p.x), fabsf(X_WC.p.y), fabsf(X_WC.p.z)});
    const bool in_plane = fabsf(dot(away, X_WC.z)) <= 1e-6f * (1 + size);
    const bool in_opening =
        camera.orthographic || length_squared(away) <= sqr(camera.aperture.radius * 1.001f);
    set_lane(&begins, i, in_plane && in_opening);
  });
  return begins;
}

}  // namespace gloam
