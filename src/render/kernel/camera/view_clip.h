#pragma once
// Surfaces that a camera's own rays pass: nearer than its near plane, of bodies that it hides, back
// faces. Rays that have left a surface meet all of them. Device-safe.

#include "render/kernel/camera/camera.h"
#include "render/kernel/surface/surface.h"

namespace gloam {

struct ViewClip {
  static constexpr int kMostPassed = 64;  ///< surfaces, one behind the other

  float near = 0;                    ///< of its plane; of wide lenses along rays [m]
  bool culls_backs = false;          ///< surfaces seen from behind are passed
  DeviceSpan<const uint8_t> hidden;  ///< by instance; empty = none

  GLOAM_HD bool is_idle() const { return !(near > 0) && !culls_backs && hidden.empty(); }

  /// Distance at which a ray of the camera begins to see [m].
  GLOAM_HD float start(const CameraView32& camera, const Ray& ray) const {
    if (!(near > 0) || is_wide(camera.lens.model)) return near;
    const Affine3f X_WC = camera_pose_at(camera.pose, ray.time);
    return near / max(-dot(ray.d, X_WC.z), 1e-3f);
  }

  /// The `found` lanes whose hit is passed.
  template <class F>
  GLOAM_HD MaskOf<F> passes(const SceneView& scene, const RayOf<F>& ray, const RayHitOf<F>& hit,
                            MaskOf<F> found) const {
    MaskOf<F> passed = false;
    if (culls_backs) {
      SurfaceOf<F> s;
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

  /// Way from a passed hit at `t` along a ray from `o` to where it goes on [m].
  static GLOAM_HD float step_past(Vec3f o, float t) {
    const float size = max(max(fabsf(o.x), fabsf(o.y)), max(fabsf(o.z), t));
    return t + 1e-5f + 2e-6f * size;
  }
};

/// The first hit of a ray of the camera that is not passed.
template <class Tracer>
GLOAM_HD bool trace_in_view(const SceneView& scene, const Tracer& tracer,
                            const CameraView32& camera, const ViewClip& clip, Ray ray,
                            RayHit* hit) {
  float begun = 0;  // [m] from the camera
  float way = clip.start(camera, ray);
  for (int n = 0; n < ViewClip::kMostPassed; ++n) {
    begun += way;
    ray.o = ray.o + ray.d * way;
    ray.tmax -= way;
    if (!(ray.tmax > 0) || !tracer.trace(ray, false, hit)) return false;
    if (!clip.passes<float>(scene, ray, *hit, true)) {
      hit->t += begun;
      return true;
    }
    way = ViewClip::step_past(ray.o, hit->t);
  }
  return false;
}

}  // namespace gloam
