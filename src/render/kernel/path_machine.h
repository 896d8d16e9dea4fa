#pragma once
// The path stage with one place at which rays are traced, for one path: on a GPU the instruction
// cache is the first wall. Draws what trace_path draws, save that in media the shadow ray's numbers
// come after those of the next direction. Device-safe.

#include "render/kernel/path.h"

namespace gloam {
namespace paths {

/// A shadow ray on its way through surfaces that let light through.
struct ShadowWalk {
  Ray ray;
  Vec3f arriving;
  uint32_t passed = 0;
};

/// Takes the surface that the shadow ray has hit; true where the ray goes on behind it.
GLOAM_HD bool pass_surface(const SceneView& scene, const RayHit& hit, ShadowWalk* walk) {
  if (!scene.lets_light_through()) {
    walk->arriving = {};
    return false;
  }
  const Surface s = make_surface<float>(scene, walk->ray, hit, {});
  walk->arriving *= walk->passed < kMaxPassed ? passing_light(s) : Vec3f{};
  walk->ray.o = leave_surface(s.p, s.geometric, walk->ray.d, hit.t);
  walk->ray.tmax -= hit.t;
  ++walk->passed;
  return max_component(walk->arriving) > 0 && walk->ray.tmax > 0;
}

}  // namespace paths

/// As trace_path. A Tracer has  bool trace(const Ray&, bool any, RayHit*) const.
template <class Tracer>
GLOAM_HD PathResult run_path(const SceneView& scene, const Tracer& tracer, const Ray& ray,
                             RayCone cone, const PathOptions& options, const Sampler& sampler) {
  paths::State<float> path;
  path.ray = ray;
  path.cone_width = cone.width;
  path.cone_spread = cone.spread;
  path.sampler = sampler;
  path.throughput = {1, 1, 1};
  paths::ShadowWalk walk;
  bool in_shadow = false, goes_on = true;
  while (in_shadow || goes_on) {
    RayHit hit;
    ++path.result.rays;
    const bool found = tracer.trace(in_shadow ? walk.ray : path.ray,
                                    in_shadow && !scene.lets_light_through(), &hit);
    bool arrives = false;  // what the shadow ray brings
    if (in_shadow) {
      in_shadow = found && paths::pass_surface(scene, hit, &walk);
      arrives = !in_shadow;
    } else {
      const paths::ArrivalOf<float> at = paths::arrive(scene, options, &path, true, found, hit);
      goes_on = at.through;
      if (at.scatters) {
        paths::NextEventOf<float> event;
        if (at.mote.scattered) {
          float band;
          event = paths::aim_at_light_in_media(scene, &path, at.mote, true, &band);
          goes_on = paths::turn_in_media(scene, options, &path, at.mote, band, true);
        } else {
          paths::ScatterOf<float> how;
          event = paths::aim_at_light(scene, &path, at.v, true, &how);
          goes_on = paths::turn(scene, options, &path, at.v, how, true);
        }
        if (event.lit) walk = {event.shadow, event.arriving, 0};
        in_shadow = event.lit && event.casts_shadow;
        arrives = event.lit && !event.casts_shadow;
      }
    }
    if (arrives && max_component(walk.arriving) > 0) {
      path.result.radiance +=
          walk.arriving * paths::through_media(scene, walk.ray, true, &path.sampler);
    }
  }
  return path.result;
}

}  // namespace gloam
