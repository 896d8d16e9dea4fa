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

/// One path, advanced by one ray at a time: trace ray(), with any_hit() whatever comes first, and
/// give the answer to advance() until it returns false.
class PathMachine {
 public:
  GLOAM_HD void start(const Ray& ray, RayCone cone, const Sampler& sampler) {
    path_ = {};
    path_.ray = ray;
    path_.cone_width = cone.width;
    path_.cone_spread = cone.spread;
    path_.sampler = sampler;
    path_.throughput = {1, 1, 1};
    in_shadow_ = false;
    goes_on_ = true;
  }

  GLOAM_HD Ray ray() const { return in_shadow_ ? shadow_.ray : path_.ray; }
  GLOAM_HD bool any_hit(const SceneView& scene) const {
    return in_shadow_ && !scene.lets_light_through();
  }
  GLOAM_HD const PathResult& result() const { return path_.result; }

  GLOAM_HD bool advance(const SceneView& scene, const PathOptions& options, bool found,
                        const RayHit& hit) {
    ++path_.result.rays;
    bool arrives = false;  // what the shadow ray brings
    if (in_shadow_) {
      in_shadow_ = found && paths::pass_surface(scene, hit, &shadow_);
      arrives = !in_shadow_;
    } else {
      const paths::ArrivalOf<float> at = paths::arrive(scene, options, &path_, true, found, hit);
      goes_on_ = at.through;
      if (at.scatters) arrives = scatter(scene, options, at);
    }
    if (arrives && max_component(shadow_.arriving) > 0) {
      path_.result.radiance +=
          shadow_.arriving * paths::through_media(scene, shadow_.ray, true, &path_.sampler);
    }
    return in_shadow_ || goes_on_;
  }

 private:
  /// Aims the shadow ray and turns the path. True where light arrives without a shadow ray.
  GLOAM_HD bool scatter(const SceneView& scene, const PathOptions& options,
                        const paths::ArrivalOf<float>& at) {
    paths::NextEventOf<float> event;
    if (at.mote.scattered) {
      float band;
      event = paths::aim_at_light_in_media(scene, &path_, at.mote, true, &band);
      goes_on_ = paths::turn_in_media(scene, options, &path_, at.mote, band, true);
    } else {
      paths::ScatterOf<float> how;
      event = paths::aim_at_light(scene, &path_, at.v, true, &how);
      goes_on_ = paths::turn(scene, options, &path_, at.v, how, true);
    }
    if (!event.lit) return false;
    shadow_ = {event.shadow, event.arriving, 0};
    in_shadow_ = event.casts_shadow;
    return !in_shadow_;
  }

  paths::State<float> path_;
  paths::ShadowWalk shadow_;
  bool in_shadow_ = false;
  bool goes_on_ = true;  ///< the path itself, after its shadow ray
};

/// As trace_path. A Tracer has  bool trace(const Ray&, bool any, RayHit*) const.
template <class Tracer>
GLOAM_HD PathResult run_path(const SceneView& scene, const Tracer& tracer, const Ray& ray,
                             RayCone cone, const PathOptions& options, const Sampler& sampler) {
  PathMachine path;
  path.start(ray, cone, sampler);
  RayHit hit;
  bool found;
  do {
    found = tracer.trace(path.ray(), path.any_hit(scene), &hit);
  } while (path.advance(scene, options, found, hit));
  return path.result();
}

}  // namespace gloam
