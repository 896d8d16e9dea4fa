#pragma once
// The path stage, as a state machine around one place where rays are traced: who runs it traces
// state.ray (any hit if state.any, else the closest) and hands the hit to path_advance, until that
// says the path has ended. So one source serves one path at a time and packets of paths.
// Device-safe.

#include "render/kernel/camera.h"
#include "render/kernel/light.h"
#include "render/kernel/sampler.h"

namespace gloam {

struct PathOptions {
  /// Segments of a path from the camera on, as Mitsuba counts: 1 = emitters seen directly, 2 =
  /// direct light, n = n - 1 reflections.
  int max_depth = 5;
  int roulette_depth = 100;  ///< segments before Russian roulette starts
};

/// What one camera sample saw.
struct PathResult {
  Vec3f radiance;  ///< [cd/m²]
  Vec3f albedo;    ///< of the first surface, 0 = sky
  Vec3f normal;    ///< of the first surface, 0 = sky
  uint32_t rays = 0;
};

/// Surfaces that a ray may pass because they are transparent, at most.
inline constexpr int kMaxPassed = 64;

struct PathState {
  Ray ray;           ///< to be traced now
  bool any = false;  ///< any hit will do
  PathResult result;

  bool is_shadow = false, has_next = false, seen_first = false;
  int depth = 0, passed = 0;
  RayCone cone;
  Sampler sampler;
  Vec3f throughput{1, 1, 1};
  float pdf_bsdf = 0;    ///< of the direction of the path's ray; 0 = from the camera
  Vec3f from;            ///< the last scattering vertex
  LightPicker picker;    ///< of that vertex
  Vec3f light_radiance;  ///< waits for the shadow ray
  Vec3f next_o, next_d;  ///< of the next path ray, which waits meanwhile
};

GLOAM_HD void path_start(PathState* state, const Ray& ray, RayCone cone, Sampler sampler) {
  *state = PathState{};
  state->ray = ray;
  state->cone = cone;
  state->sampler = sampler;
}

namespace paths {

/// The shadow ray of the last vertex has returned; true if the path goes on.
GLOAM_HD bool end_shadow(const SceneView& scene, PathState* p, bool found, const RayHit& hit) {
  if (found && scene.has_transparent && p->passed < kMaxPassed) {
    const Surface s = make_surface(scene, p->ray, hit, {});
    if (s.opacity < 1.0f) {
      p->light_radiance *= 1.0f - s.opacity;
      p->ray.o = leave_surface(s.p, s.geometric, p->ray.d, hit.t);
      p->ray.tmax -= hit.t;
      ++p->passed;
      if (p->ray.tmax > 0) return true;
      found = false;
    }
  }
  if (!found) p->result.radiance += p->light_radiance;
  if (!p->has_next) return false;
  p->is_shadow = p->any = false;
  p->passed = 0;
  p->ray.o = p->next_o;
  p->ray.d = p->next_d;
  p->ray.tmax = 1e30f;
  return true;
}

/// Samples one light and one direction at the surface; true if there is a ray to trace.
GLOAM_HD bool scatter(const SceneView& scene, const PathOptions& options, PathState* p,
                      const Surface& s) {
  const Vec3f wo_W = -p->ray.d;
  Frame frame;
  const Bsdf bsdf = surface_bsdf(scene, s, wo_W, &frame);
  const Vec3f wo = frame.to_local(wo_W);
  p->cone.width += p->cone.spread * s.t;

  p->picker.prepare(scene, s.p, s.geometric);
  const Vec2f choice = p->sampler.next_2d();  // of the light, of the lobe
  const LightSample light =
      p->picker.sample(scene, s.p, choice.x, p->sampler.next_2d(), p->ray.time, p->cone.spread);
  if (light.pdf > 0 && dot(light.wi, s.geometric) > 0) {
    float pdf = 0;
    const Vec3f f = eval_bsdf(bsdf, wo, frame.to_local(light.wi), &pdf);
    if (max_component(f) > 0) {
      const float weight = light.is_delta ? 1.0f : mis_weight(light.pdf, pdf);
      p->light_radiance = p->throughput * f * light.radiance * (weight / light.pdf);
      p->is_shadow = light.casts_shadow;
      if (!light.casts_shadow) p->result.radiance += p->light_radiance;
    }
  }

  // The last segment can only bring light from something that a ray can hit.
  p->has_next = false;
  if (p->depth + 1 < options.max_depth || scene.has_emitters) {
    const BsdfSample sample = sample_bsdf(bsdf, wo, choice.y, p->sampler.next_2d());
    const Vec3f wi = frame.to_world(sample.wi);
    if (sample.pdf > 0 && dot(wi, s.geometric) > 0 && max_component(sample.weight) > 0) {
      p->throughput *= sample.weight;
      p->pdf_bsdf = sample.pdf;
      p->from = s.p;
      // The cone widens with the lobe: texture detail that a broad lobe averages is not sought.
      p->cone.spread += 0.2f * sqrtf(min(1.0f / (kPi * sample.pdf), 1.0f));
      p->has_next = true;
      p->next_o = leave_surface(s.p, s.geometric, wi, s.t);
      p->next_d = wi;
    }
  }
  if (p->is_shadow) {
    p->any = !scene.has_transparent;
    aim_shadow_ray(s, light, &p->ray);
  } else {
    p->ray.o = p->next_o;
    p->ray.d = p->next_d;
    p->ray.tmax = 1e30f;
  }
  return p->is_shadow || p->has_next;
}

}  // namespace paths

/// Takes the hit of state->ray; false when the path has ended and state->result is final: an
/// unbiased estimate of the radiance along the camera's ray. At each vertex one light and one
/// direction of the BSDF are sampled and combined by the power heuristic; transparent surfaces are
/// passed by chance (path) or by attenuation (shadow rays).
GLOAM_HD bool path_advance(const SceneView& scene, const PathOptions& options, PathState* p,
                           bool found, const RayHit& hit) {
  ++p->result.rays;
  if (p->is_shadow) return paths::end_shadow(scene, p, found, hit);

  Vec3f& radiance = p->result.radiance;
  if (p->pdf_bsdf > 0 && scene.has_visible_lights) {
    const float reach = found ? hit.t : 1e30f;
    radiance +=
        p->throughput * visible_lights(scene, p->ray, reach, p->from, p->picker, p->pdf_bsdf);
  }
  if (!found) {
    const Vec3f sky = sky_radiance(scene, p->ray.d, p->cone.spread);
    const float weight =
        p->pdf_bsdf > 0 ? mis_weight(p->pdf_bsdf, p->picker.sky_pdf(p->ray.d)) : 1.0f;
    radiance += p->throughput * (p->depth > 0 ? sky + scene.sky_ambient : sky) * weight;
    return false;
  }
  if (p->depth > 0 && p->depth + 1 >= options.max_depth) {
    // Only what the last surface gives off counts: most give nothing.
    const MaterialView& m = scene.materials[scene.instances[hit.instance].material];
    if (!m.transparent && max_component(m.emission) <= 0) return false;
  }
  const Surface s = make_surface(scene, p->ray, hit, p->cone);
  if (s.opacity < 1.0f && p->passed < kMaxPassed && p->sampler.next_1d() >= s.opacity) {
    p->ray.o = leave_surface(s.p, s.geometric, p->ray.d, hit.t);
    p->cone.width += p->cone.spread * hit.t;
    ++p->passed;
    return true;
  }
  p->passed = 0;
  if (!p->seen_first) {
    p->seen_first = true;
    p->result.albedo = s.base_color;
    p->result.normal = s.normal;
  }
  if (max_component(s.emission) > 0) {
    float weight = 1;
    if (p->pdf_bsdf > 0 && s.instance->light >= 0) {
      const float selected = p->picker.probability(scene, static_cast<uint32_t>(s.instance->light));
      const float pdf =
          lights::instance_pdf(scene, *s.instance, p->from, s.p, s.geometric, p->ray.time);
      weight = mis_weight(p->pdf_bsdf, selected * pdf);
    }
    radiance += p->throughput * surface_emission(s) * weight;
  }
  if (++p->depth >= options.max_depth) return false;
  if (p->depth > options.roulette_depth) {
    const float survive = min(max_component(p->throughput), 0.95f);
    if (p->sampler.next_1d() >= survive) return false;
    p->throughput = p->throughput / survive;
  }
  return paths::scatter(scene, options, p, s);
}

/// Runs one path to its end. A Tracer has one function,
///   bool trace(const Ray& ray, bool any, RayHit* hit) const.
template <class Tracer>
GLOAM_HD PathResult trace_path(const SceneView& scene, const Tracer& tracer, const Ray& ray,
                               RayCone cone, const PathOptions& options, Sampler sampler) {
  PathState state;
  path_start(&state, ray, cone, sampler);
  for (;;) {
    RayHit hit;
    const bool found = tracer.trace(state.ray, state.any, &hit);
    if (!path_advance(scene, options, &state, found, hit)) return state.result;
  }
}

}  // namespace gloam
