#pragma once
// A LiDAR's beams while it moves. Device-safe.

#include "geometry/motion_keys.h"
#include "render/kernel/math/ray.h"

namespace gloam {

struct LidarBeam {
  Vec3f d;          ///< unit, in the sensor's frame L: x ahead, y to the left, z up
  float time = 0;   ///< 0 … 1 between the keys that the renderer was updated to
  uint32_t id = 0;  ///< of the beam in its scan, for its draws
};

/// Motion of a sensor while it scans: L turns evenly about a fixed axis and moves evenly. Times run
/// from 0 to 1.
struct LidarMotion {
  Affine3f X_WL;   ///< at 0
  Vec3f shift;     ///< of its origin until 1 [m]
  Vec3f axis;      ///< of its turn, unit, in L
  float turn = 0;  ///< [turns]
};

template <class F>
GLOAM_HD RayOf<F> beam_ray(const LidarMotion& motion, Vec3Of<F> d_L, F time) {
  RayOf<F> ray;
  if (motion.turn != 0) {  // Rodrigues' formula
    F s, c;
    const F turn = time * motion.turn;
    sincos_turn(turn - floor_of(turn), &s, &c);
    const Vec3Of<F> axis = in_all_lanes<F>(motion.axis);
    d_L = d_L * c + cross(axis, d_L) * s + axis * (dot(axis, d_L) * (1.0f - c));
  }
  ray.d = normalize(transform_vector(pose_in_all_lanes<F>(motion.X_WL), d_L));
  ray.o = in_all_lanes<F>(motion.X_WL.p) + in_all_lanes<F>(motion.shift) * time;
  ray.time = time;
  return ray;
}

/// Ray of a sensor that moves through several such stretches, equally long, one after the other.
template <class F>
GLOAM_HD RayOf<F> beam_ray(DeviceSpan<const LidarMotion> stretches, Vec3Of<F> d_L, F time) {
  uint32_t stretch[Lanes<F>::kCount];
  F fraction{};
  bool together = true;  // beams are in the order of time, nearly
  each_lane(MaskOf<F>(true), [&](int i) {
    float one;
    stretch[i] = key_before(stretches.size + 1, lane(time, i), &one);
    set_lane(&fraction, i, one);
    together = together && stretch[i] == stretch[0];
  });
  RayOf<F> ray;
  if (together) {
    ray = beam_ray(stretches[stretch[0]], d_L, fraction);
  } else {
    each_lane(MaskOf<F>(true), [&](int i) {
      const Ray one = beam_ray<float>(stretches[stretch[i]], lane(d_L, i), lane(fraction, i));
      set_lane(&ray.o, i, one.o);
      set_lane(&ray.d, i, one.d);
    });
  }
  ray.time = time;
  return ray;
}

}  // namespace gloam
