#include "render/cpu/view_clip.h"

#include <cmath>

namespace gloam {

MaskLanes ViewClip::from_camera(const RayOf<FloatLanes>& ray, MaskLanes active) const {
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

float ViewClip::start(const Ray& ray) const {
  if (!(near > 0) || is_wide(camera.lens.model)) return near;
  const Affine3f X_WC = camera_pose_at(camera.pose, ray.time);
  return near / max(-dot(ray.d, X_WC.z), 1e-3f);
}

MaskLanes ViewClip::passes(const RayOf<FloatLanes>& ray, const RayHitOf<FloatLanes>& hit,
                           MaskLanes found) const {
  MaskLanes passed = false;
  if (culls_backs) {
    SurfaceOf<FloatLanes> s;
    surfaces::place_surface(scene, ray, hit, found, &s);
    passed = found & (dot(s.geometric, ray.d) > 0.0f);
    // Cloth and the like have no back.
    each_lane(passed, [&](int i) {
      if (scene.instances[lane(hit.instance, i)].shape == ShapeType::kDeformable)
        set_lane(&passed, i, false);
    });
  }
  if (hidden.empty()) return passed;
  each_lane(found, [&](int i) {
    const uint32_t row = lane(hit.instance, i);  // what joins a scene later is never hidden
    if (row < hidden.size && hidden[row] != 0) set_lane(&passed, i, true);
  });
  return passed;
}

}  // namespace gloam
