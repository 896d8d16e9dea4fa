#pragma once
// One path of the measure of the direct stage's ambient light. Device-safe.

#include "render/kernel/camera/channels.h"
#include "render/kernel/path/path.h"

namespace gloam {

inline constexpr int kLog2AmbientPaths = 11;  ///< all together

/// Light that a path has found: it arrives at a surface which the camera sees.
struct AmbientPath {
  int facing = -1;  ///< of the surface, as LightGuide::facing_of; -1 = no surface
  Vec3f light;      ///< [cd/m²]
};

/// Sum over paths from surfaces of one facing.
struct AmbientSum {
  Vec3f light;
  float count = 0;
};

/// Light that surfaces in view receive, by the axis that they face, beyond that straight from lamps
/// and suns. `sums`: by facing, and of `all`, over 2^kLog2AmbientPaths paths.
GLOAM_HD AmbientCube mean_ambient(const AmbientSum* sums, const AmbientSum& all) {
  constexpr float kPriorFraction = 0.05f;  // of all paths, for the mean over all facings
  constexpr float kUsual = kPriorFraction * static_cast<float>(1 << kLog2AmbientPaths);
  AmbientCube ambient;
  if (all.count == 0) return ambient;
  for (int k = 0; k < LightGuide::kFacings; ++k) {
    ambient.light[k] =
        (sums[k].light + all.light * (kUsual / all.count)) / (sums[k].count + kUsual);
  }
  return ambient;
}

namespace ambient {

inline constexpr float kAmbientConeSpread =
    0.2f;  ///< of the rays' cones: no fine texture is sought

/// Light that arrives along the ray, save that of lights which the direct tier samples itself.
template <class Tracer>
GLOAM_HD Vec3f incoming(const SceneView& scene, const Tracer& tracer, const Ray& ray, int max_depth,
                        Sampler sampler) {
  RayHit hit;
  if (!tracer.trace(ray, false, &hit)) {
    return sky_radiance(scene, ray.d, kAmbientConeSpread) + scene.sky_ambient;
  }
  if (scene.instances[hit.instance].light >= 0) return {};
  constexpr int kRoulette = 3;
  return trace_path(scene, tracer, ray, 0.0f, kAmbientConeSpread, {max_depth - 1, kRoulette},
                    sampler)
      .radiance;
}

}  // namespace ambient

/// Path `index` of a picture of width x height pixels.
template <class Tracer>
GLOAM_HD AmbientPath ambient_path(const SceneView& scene, const Tracer& tracer,
                                  const CameraView32& camera, int width, int height, int max_depth,
                                  uint32_t index) {
  Sampler sampler = Sampler::make(0, 0, 0, 0, index, kLog2AmbientPaths);
  const Vec2f at = sampler.next_2d(), u = sampler.next_2d();
  RayCone cone;
  const Ray view = camera_ray(camera, at.x * static_cast<float>(width),
                              at.y * static_cast<float>(height), 0, &cone);
  Surface s;
  RayHit hit;
  uint32_t rays = 0;
  AmbientPath path;
  if (!find_first(scene, tracer, view, cone, &s, &hit, &rays)) return path;
  Ray ray;
  ray.d = Frame::from_z(s.geometric).to_world(sample_cosine_hemisphere(u));
  ray.o = leave_surface(s.p, s.geometric, ray.d, s.t);
  path.facing = static_cast<int>(LightGuide::facing_of(s.geometric));
  path.light = ambient::incoming(scene, tracer, ray, max_depth, sampler);
  return path;
}

}  // namespace gloam
