#pragma once
// Sky that rays which leave the scene see: an environment map, or MuJoCo's cube. Device-safe.

#include "render/kernel/surface/texture.h"

namespace gloam {

/// Luminance of the sky towards the unit world direction d [cd/m²], filtered over a cone of the
/// full angle `spread` [rad]. MuJoCo turns its skybox by 90 degrees about +X.
GLOAM_HD Vec3f sky_radiance(const SceneView& scene, Vec3f d, float spread) {
  if (scene.has_environment()) return environment_radiance(scene.environment, d, spread);
  if (!scene.has_sky_texture()) return {0, 0, 0};
  return lookup_cube(scene, scene.sky_texture, {d.x, d.z, -d.y}, spread).rgb * scene.sky_scale;
}

/// The same for directions in lanes, without the filter where directions are sampled from a map:
/// the two ways to find its light must see the same.
template <class F>
GLOAM_HD Vec3Of<F> sky_radiance_of(const SceneView& scene, Vec3Of<F> d, F spread,
                                   MaskOf<F> active) {
  Vec3Of<F> out;
  const bool filter = !scene.has_environment();
  if (filter && !scene.has_sky_texture()) return out;
  each_lane(active, [&](int i) {
    set_lane(&out, i, sky_radiance(scene, lane(d, i), filter ? lane(spread, i) : 0.0f));
  });
  return out;
}

}  // namespace gloam
