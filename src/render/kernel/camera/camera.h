#pragma once
// Cameras: pixels to rays and points to pixels. C looks along -Z with +Y up. Device-safe.

#include "geometry/lens.h"
#include "render/kernel/surface/surface.h"

namespace gloam {

/// A camera's pose at one instant; the rotation as a unit quaternion wxyz.
struct CameraKey {
  Vec3f p;
  float q[4] = {1, 0, 0, 0};
};

struct CameraPose {
  Affine3f X_WC_open;                ///< at time 0
  Affine3f X_WC_previous;            ///< at the frame before
  DeviceSpan<const CameraKey> keys;  ///< evenly over times 0 … 1; empty = it stands still
};

/// Whether the camera is where it was at the frame before.
GLOAM_HD bool stands_still(const CameraPose& pose) {
  const Affine3f &a = pose.X_WC_open, &b = pose.X_WC_previous;
  return pose.keys.empty() && a.x == b.x && a.y == b.y && a.z == b.z && a.p == b.p;
}

/// Exposure times of the rows of a picture, in times of the scene's keys, 0 … 1.
struct Shutter {
  float open = 0;    ///< of the first row
  float length = 1;  ///< of every row's exposure
  float row = 0;     ///< delay from a row to the next: above 0 a rolling shutter
};

/// The opening of a thin lens.
struct Aperture {
  float radius = 0;  ///< [m]; 0 = all is sharp
  float focus = 1;   ///< distance of what is sharp [m]: along the axis, of wide lenses along rays
};

struct CameraView32 {
  float fx = 1, fy = 1, cx = 0, cy = 0;  ///< [px]; orthographic: [px/m]
  bool orthographic = false;
  CameraPose pose;
  LensOf<float> lens;
  Shutter shutter;
  Aperture aperture;

  GLOAM_HD bool is_plain() const {
    return lens.model == LensModel::kPinhole && !(aperture.radius > 0);
  }
  GLOAM_HD bool is_pinhole() const { return kPlainScenes || lens.model == LensModel::kPinhole; }
  GLOAM_HD bool has_aperture() const { return !kPlainScenes && aperture.radius > 0; }
  /// The time of row `y` when a fraction `u` of its exposure has passed.
  GLOAM_HD float time_of(int y, float u) const {
    return min(shutter.open + shutter.row * static_cast<float>(y) + shutter.length * u, 1.0f);
  }
};

/// The rotation that a unit quaternion wxyz makes, about the point p.
GLOAM_HD Affine3f pose_of(const float* q, Vec3f p) {
  const float w = q[0], x = q[1], y = q[2], z = q[3];
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
          p};
}

/// Between two keys, which are close: positions evenly, rotations by the mean of their quaternions
/// made unit, so that the camera stays rigid.
GLOAM_HD Affine3f camera_pose_at(const CameraPose& pose, float time) {
  if (kPlainScenes || pose.keys.empty() || time == 0) return pose.X_WC_open;
  float fraction;
  const uint32_t key = key_before(pose.keys.size, time, &fraction);
  const CameraKey &a = pose.keys[key], &b = pose.keys[key + 1];
  float inner = 0, square = 0, q[4];
  for (int i = 0; i < 4; ++i) inner += a.q[i] * b.q[i];
  for (int i = 0; i < 4; ++i) {
    q[i] = lerp(a.q[i], inner < 0 ? -b.q[i] : b.q[i], fraction);
    square += q[i] * q[i];
  }
  const float scale = 1.0f / sqrtf(square);
  for (float& value : q) value *= scale;
  return pose_of(q, lerp(a.p, b.p, fraction));
}

/// Whether the ray of a pixel sees anything: some lenses leave parts of the picture black. Rays of
/// such pixels end where they start.
GLOAM_HD bool sees(const Ray& ray) { return ray.tmax > 0; }

/// The point (x, y) of the plane across the unit vector d.
GLOAM_HD Vec3f across(Vec3f d, float x, float y) {
  const Frame frame = Frame::from_z(d);
  return frame.x * x + frame.y * y;
}

/// Ray through the point (u, v) [px] of the picture, and its footprint. `lens`: a point of the unit
/// square that picks one of the aperture's; the middle of the aperture when there is none.
GLOAM_HD Ray camera_ray(const CameraView32& camera, float u, float v, float time, RayCone* cone,
                        const Vec2f* lens = nullptr) {
  const Affine3f X_WC = camera_pose_at(camera.pose, time);
  const float x = (u - camera.cx) / camera.fx, y = (camera.cy - v) / camera.fy;
  Ray ray;
  ray.time = time;
  if (camera.orthographic) {
    ray.o = transform_point(X_WC, {x, y, 0});
    ray.d = normalize(-X_WC.z);
    *cone = {1.0f / camera.fx, 0.0f};
    return ray;
  }
  ray.o = X_WC.p;
  Vec3f d_C{x, y, -1.0f};
  if (camera.is_pinhole()) {
    ray.d = normalize(transform_vector(X_WC, d_C));
    *cone = {0.0f, 1.0f / (camera.fx * sqrtf(1.0f + x * x + y * y))};
  } else {
    float X, Y, Z, angle;
    if (!lens_unproject(camera.lens, x, -y, &X, &Y, &Z, &angle)) {
      ray.d = normalize(-X_WC.z);
      ray.tmax = 0;
      *cone = {};
      return ray;
    }
    d_C = {X, -Y, -Z};
    ray.d = normalize(transform_vector(X_WC, d_C));
    *cone = {0.0f, angle / sqrtf(camera.fx * camera.fy)};
  }
  if (lens == nullptr || !camera.has_aperture()) return ray;
  const Vec2f at = to_disc(*lens);
  float sine, cosine;
  sincos_turn(at.y, &sine, &cosine);
  const float r = camera.aperture.radius * sqrtf(at.x);
  const bool wide = is_wide(camera.lens.model);
  const Vec3f o_C =
      wide ? across(normalize(d_C), r * cosine, r * sine) : Vec3f{r * cosine, r * sine, 0.0f};
  const Vec3f sharp_C = d_C * (wide ? camera.aperture.focus : -camera.aperture.focus / d_C.z);
  ray.o = transform_point(X_WC, o_C);
  ray.d = normalize(transform_vector(X_WC, sharp_C - o_C));
  return ray;
}

/// camera_ray() of many points.
template <class F>
GLOAM_HD RayOf<F> camera_rays(const CameraView32& camera, F u, F v, F time, RayConeOf<F>* cone,
                              const Vec2Of<F>* lens = nullptr) {
  RayOf<F> rays;
  const bool is_sharp = lens == nullptr || !camera.has_aperture();
  if (!camera.orthographic && camera.is_pinhole() && is_sharp && camera.pose.keys.empty()) {
    const F x = (u - camera.cx) / camera.fx, y = (camera.cy - v) / camera.fy;
    const AffineOf<F> X_WC = pose_in_all_lanes<F>(camera.pose.X_WC_open);
    rays.o = X_WC.p;
    rays.d = normalize(transform_vector(X_WC, Vec3Of<F>{x, y, F(-1.0f)}));
    rays.time = time;
    *cone = {F(0.0f), 1.0f / (camera.fx * square_root(1.0f + x * x + y * y))};
    return rays;
  }
  each_lane(MaskOf<F>(true), [&](int i) {
    RayCone one;
    const Vec2f at = is_sharp ? Vec2f{} : lane(*lens, i);
    const Ray ray =
        camera_ray(camera, lane(u, i), lane(v, i), lane(time, i), &one, is_sharp ? nullptr : &at);
    set_lane(&rays.o, i, ray.o);
    set_lane(&rays.d, i, ray.d);
    set_lane(&rays.tmax, i, ray.tmax);
    set_lane(&rays.time, i, ray.time);
    set_lane(&cone->width, i, one.width);
    set_lane(&cone->spread, i, one.spread);
  });
  return rays;
}

/// Projects the points p_W of the `active` lanes into the picture [px]; returns the lanes that the
/// camera sees.
template <class F>
GLOAM_HD MaskOf<F> project_points(const CameraView32& camera, const Affine3f& X_WC, Vec3Of<F> p_W,
                                  MaskOf<F> active, Vec2Of<F>* uv) {
  const Vec3Of<F> p = transform_point(pose_in_all_lanes<F>(inverse(X_WC)), p_W);
  if (!camera.orthographic && !camera.is_pinhole()) {
    MaskOf<F> seen = false;
    each_lane(active, [&](int i) {
      float x, y;
      const Vec3f one = lane(p, i);
      if (!lens_project(camera.lens, one.x, -one.y, -one.z, &x, &y)) return;
      set_lane(&seen, i, true);
      set_lane(uv, i, {camera.cx + camera.fx * x, camera.cy + camera.fy * y});
    });
    return seen;
  }
  const MaskOf<F> seen = active & (MaskOf<F>(camera.orthographic) | !(p.z > -1e-9f));
  const F s = camera.orthographic ? F(1.0f) : -1.0f / p.z;
  *uv = {camera.cx + camera.fx * p.x * s, camera.cy - camera.fy * p.y * s};
  return seen;
}

/// Projects the point p_W into the picture [px]; false where the camera does not see it.
GLOAM_HD bool project(const CameraView32& camera, const Affine3f& X_WC, Vec3f p_W, Vec2f* uv) {
  return project_points<float>(camera, X_WC, p_W, true, uv);
}

/// The pixel filter is a Gaussian of this standard deviation [px], cut at the other [px].
inline constexpr float kPixelFilterSigma = 0.42f, kPixelFilterCut = 1.25f;

/// Offset from the pixel's centre [px], by importance sampling of the pixel filter. All samples
/// weigh the same (filter importance sampling, Ernst et al. 2006).
template <class F>
GLOAM_HD Vec2Of<F> sample_pixel_filter(Vec2Of<F> u) {
  u = to_disc(u);
  constexpr float kTruncatedMass = 0.98807186f;  // 1 - exp(-(cut / sigma)² / 2)
  const F r = kPixelFilterSigma * square_root(-2.0f * natural_log(1.0f - u.x * kTruncatedMass));
  F s, c;
  sincos_turn(u.y, &s, &c);
  return {r * c, r * s};
}

/// Weight, of any scale, of what is at an offset from the pixel's centre [px].
GLOAM_HD float pixel_filter(Vec2f offset) {
  const float r2 = sqr(offset.x) + sqr(offset.y);
  return r2 < sqr(kPixelFilterCut) ? expf(-0.5f * r2 / sqr(kPixelFilterSigma)) : 0.0f;
}

}  // namespace gloam
