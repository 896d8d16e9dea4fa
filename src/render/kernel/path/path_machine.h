#pragma once
// The path stage with one place at which rays are traced, for one path: on a GPU the instruction
// cache is the first wall. Uses the random numbers that trace_path uses, save that in media the
// shadow ray's numbers come after those of the next direction. Device-safe.

#include "render/kernel/path/path.h"

namespace gloam {
namespace paths {

/// A shadow ray, maybe on its way through surfaces that let light through.
struct ShadowWalk {
  Ray ray;
  Vec3f arriving;
  uint32_t passed = 0;
};

/// Takes the surface that the shadow ray has hit; true where the ray goes on behind it.
GLOAM_HD bool pass_surface(const SceneView& scene, const RayHit& hit, ShadowWalk* walk) {
  const Surface s = make_surface<float>(scene, walk->ray, hit, {});
  walk->arriving *= walk->passed < kMaxPassed ? passing_light(s) : Vec3f{};
  walk->ray.o = leave_surface(s.p, s.geometric, walk->ray.d, hit.t);
  walk->ray.tmax -= hit.t;
  ++walk->passed;
  return max_component(walk->arriving) > 0 && walk->ray.tmax > 0;
}

}  // namespace paths

/// One path, advanced from vertex to vertex: trace shadow(), then ray(), neither where its tmax is
/// 0, and give the answers to advance() until it returns false.
class PathMachine {
 public:
  /// `probabilities` are the path's as long as it runs.
  GLOAM_HD void start(const Ray& ray, RayCone cone, const Sampler& sampler,
                      LightProbabilitiesOf<float>* probabilities) {
    path_ = {};
    path_.light_sampler.keep_in(probabilities);
    path_.ray = ray;
    path_.cone_width = cone.width;
    path_.cone_spread = cone.spread;
    path_.sampler = sampler;
    path_.throughput = {1, 1, 1};
    in_shadow_ = false;
    continues_ = true;
  }

  /// Shadow ray: any hit ends it.
  GLOAM_HD Ray shadow(const SceneView& scene) const {
    Ray ray = shadow_.ray;
    if (!in_shadow_ || scene.lets_light_through()) ray.tmax = 0;
    return ray;
  }
  GLOAM_HD Ray ray(const SceneView& scene) const {
    if (in_shadow_ && scene.lets_light_through()) return shadow_.ray;
    Ray ray = path_.ray;
    if (!continues_) ray.tmax = 0;
    return ray;
  }
  GLOAM_HD const PathResult& result() const { return path_.result; }

  GLOAM_HD bool advance(const SceneView& scene, const PathOptions& options, bool shadowed,
                        bool found, const RayHit& hit) {
    if (in_shadow_) {
      ++path_.result.rays;
      if (scene.lets_light_through()) {
        in_shadow_ = found && paths::pass_surface(scene, hit, &shadow_);
        if (!in_shadow_) add_shadow_light(scene);
        return in_shadow_ || continues_;
      }
      in_shadow_ = false;
      if (!shadowed) add_shadow_light(scene);
    }
    if (!continues_) return false;
    ++path_.result.rays;
    const paths::SegmentEndOf<float> at =
        paths::end_segment(scene, options, &path_, true, found, hit);
    continues_ = at.through;
    if (at.scatters) scatter(scene, options, at);
    return in_shadow_ || continues_;
  }

 private:
  /// Samples a light and a direction at the vertex.
  GLOAM_HD void scatter(const SceneView& scene, const PathOptions& options,
                        const paths::SegmentEndOf<float>& at) {
    paths::NextEventOf<float> event;
    if (at.medium_vertex.scattered) {
      paths::MediumScatterOf<float> how;
      event = paths::sample_light_in_media(scene, &path_, at.medium_vertex, true, &how);
      continues_ =
          paths::sample_phase_direction(scene, options, &path_, at.medium_vertex, how, true);
    } else {
      paths::ScatterOf<float> how;
      event = paths::sample_light(scene, &path_, at.v, true, &how);
      continues_ = paths::sample_direction(scene, options, &path_, at.v, how, true);
    }
    if (!event.lit) return;
    shadow_ = {event.shadow, event.arriving, 0};
    in_shadow_ = event.casts_shadow;
    if (!in_shadow_) add_shadow_light(scene);
  }

  /// Adds the light that is left of the shadow ray's.
  GLOAM_HD void add_shadow_light(const SceneView& scene) {
    if (!(max_component(shadow_.arriving) > 0)) return;
    path_.result.radiance +=
        shadow_.arriving * paths::through_media(scene, shadow_.ray, true, &path_.sampler);
  }

  paths::State<float> path_;
  paths::ShadowWalk shadow_;
  bool in_shadow_ = false;  ///< a shadow ray is to be traced
  bool continues_ = true;   ///< the path itself
};

/// Traces a path as trace_path does.
template <class Tracer>
GLOAM_HD PathResult run_path(const SceneView& scene, const Tracer& tracer, const Ray& ray,
                             RayCone cone, const PathOptions& options, const Sampler& sampler) {
  LightProbabilitiesOf<float> probabilities;
  PathMachine path;
  path.start(ray, cone, sampler, &probabilities);
  RayHit hit;
  bool shadowed, found;
  do {
    const Ray before = path.shadow(scene), next = path.ray(scene);
    shadowed = before.tmax > 0 && tracer.occluded(before, true);
    found = next.tmax > 0 && tracer.closest(next, true, false, &hit);
  } while (path.advance(scene, options, shadowed, found, hit));
  return path.result();
}

}  // namespace gloam
