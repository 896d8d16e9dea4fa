#pragma once
// Pinhole and orthographic cameras. C looks along -Z with +Y up. Device-safe.

#include "render/kernel/surface.h"

namespace gloam {

struct CameraPose {
  Affine3f X_WC_open, X_WC_close, X_WC_previous;
  bool moving = false;
};

struct CameraView32 {
  float fx = 1, fy = 1, cx = 0, cy = 0;  ///< [px]; orthographic: [px/m]
  bool orthographic = false;
  CameraPose pose;
};

GLOAM_HD Affine3f camera_pose_at(const CameraPose& pose, float time) {
  if (!pose.moving || time == 0) return pose.X_WC_open;
  return lerp(pose.X_WC_open, pose.X_WC_close, time);
}

/// Ray through the point (u, v) [px] of the picture, and its footprint.
GLOAM_HD Ray camera_ray(const CameraView32& camera, float u, float v, float time, RayCone* cone) {
  const Affine3f X_WC = camera_pose_at(camera.pose, time);
  const float x = (u - camera.cx) / camera.fx, y = (camera.cy - v) / camera.fy;
  Ray ray;
  ray.time = time;
  if (camera.orthographic) {
    ray.o = transform_point(X_WC, {x, y, 0});
    ray.d = normalize(-X_WC.z);
    *cone = {1.0f / camera.fx, 0.0f};
  } else {
    ray.o = X_WC.p;
    ray.d = normalize(transform_vector(X_WC, {x, y, -1.0f}));
    *cone = {0.0f, 1.0f / (camera.fx * sqrtf(1.0f + x * x + y * y))};
  }
  return ray;
}

/// Where the point p_W appears [px]; false behind the camera.
GLOAM_HD bool project(const CameraView32& camera, const Affine3f& X_WC, Vec3f p_W, Vec2f* uv) {
  const Vec3f p = transform_point(inverse(X_WC), p_W);
  if (!camera.orthographic && p.z > -1e-9f) return false;
  const float s = camera.orthographic ? 1.0f : -1.0f / p.z;
  *uv = {camera.cx + camera.fx * p.x * s, camera.cy - camera.fy * p.y * s};
  return true;
}

/// Offset from the pixel's centre [px], by importance sampling of the pixel filter: a Gaussian of
/// standard deviation 0.42 px cut at 1.25 px. All samples weigh the same (filter importance
/// sampling, Ernst et al. 2006).
GLOAM_HD Vec2f sample_pixel_filter(Vec2f u) {
  constexpr float kSigma = 0.42f, kCut = 1.25f;
  const float reach = 1.0f - expf(-0.5f * kCut * kCut / (kSigma * kSigma));
  const float r = kSigma * sqrtf(-2.0f * logf(1.0f - u.x * reach));
  float s, c;
  sincos_turn(u.y, &s, &c);
  return {r * c, r * s};
}

}  // namespace gloam
