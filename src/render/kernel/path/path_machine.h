#pragma once
// The path stage with one place at which rays are traced, for one path: on a GPU the instruction
// cache is the first wall. Uses the random numbers that trace_path uses, save that in media the
// shadow ray's numbers come after those of the next direction. Device-safe.

#include "render/kernel/path/path.h"

namespace gloam {
namespace paths {

/// A shadow ray, maybe on its way through surfaces that let light through.
struct ShadowWalk {
  Ray ray;  ///< the part that is left of it
  Vec3f arriving;
  uint32_t passed = 0;
  float length = 0;  ///< of the whole ray [m]
  /// From its start to ray.o [m]: ray.tmax of distant light has too few digits to derive it from.
  float behind = 0;

  GLOAM_HD static ShadowWalk of(const NextEventOf<float>& event) {
    return {event.shadow, event.arriving, 0, event.shadow.tmax};
  }
  GLOAM_HD Ray whole_ray() const { return {ray.o - ray.d * behind, ray.d, length, ray.time}; }
};

/// Takes the surface that the shadow ray has hit; true where the ray goes on behind it.
GLOAM_HD bool pass_surface(const Surface& s, ShadowWalk* walk) {
  walk->arriving *= walk->passed < kMaxPassed ? passing_light(s) : Vec3f{};
  walk->ray.o = leave_surface(s.p, s.geometric, walk->ray.d, s.t);
  walk->ray.tmax -= s.t;
  walk->behind += s.t;
  ++walk->passed;
  return max_component(walk->arriving) > 0 && walk->ray.tmax > 0;
}

/// Adds the light that is left at the end of a shadow ray.
GLOAM_HD void add_shadow_light(const SceneView& scene, const ShadowWalk& walk, State<float>* path) {
  if (!(max_component(walk.arriving) > 0)) return;
  path->result.radiance +=
      walk.arriving * through_media(scene, walk.whole_ray(), true, &path->sampler);
}

/// Samples a light and a direction at the surface; true where the path goes on.
GLOAM_HD bool sample_at_surface(const SceneView& scene, const PathOptions& options,
                                const Surface& v, State<float>* path, NextEventOf<float>* event) {
  ScatterOf<float> how;
  *event = sample_light(scene, path, v, true, &how);
  return sample_direction(scene, options, path, v, how, true);
}
/// The same in media.
GLOAM_HD bool sample_in_media(const SceneView& scene, const PathOptions& options,
                              const MediumVertexOf<float>& v, State<float>* path,
                              NextEventOf<float>* event) {
  MediumScatterOf<float> how;
  *event = sample_light_in_media(scene, path, v, true, &how);
  return sample_phase_direction(scene, options, path, v, how, true);
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
        in_shadow_ = found && paths::pass_surface(make_surface<float>(scene, shadow_.ray, hit, {}),
                                                  &shadow_);
        if (!in_shadow_) paths::add_shadow_light(scene, shadow_, &path_);
        return in_shadow_ || continues_;
      }
      in_shadow_ = false;
      if (!shadowed) paths::add_shadow_light(scene, shadow_, &path_);
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
    continues_ = at.medium_vertex.scattered
                     ? paths::sample_in_media(scene, options, at.medium_vertex, &path_, &event)
                     : paths::sample_at_surface(scene, options, at.v, &path_, &event);
    if (!event.lit) return;
    shadow_ = paths::ShadowWalk::of(event);
    in_shadow_ = event.casts_shadow;
    if (!in_shadow_) paths::add_shadow_light(scene, shadow_, &path_);
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
