#pragma once
// The path stage. A Tracer has one function,
//   bool trace(const Ray& ray, bool any, RayHit* hit) const
// that finds the closest hit, or with `any` just whether there is one. Device-safe.

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

/// Unbiased estimate of the radiance along `ray`: at each vertex one light and one direction of the
/// BSDF are sampled and combined by the power heuristic; transparent surfaces are passed by chance
/// (path) or by attenuation (shadow rays). Both kinds of rays go through one call of `trace`.
template <class Tracer>
GLOAM_HD PathResult trace_path(const SceneView& scene, const Tracer& tracer, Ray ray, RayCone cone,
                               const PathOptions& options, Sampler sampler) {
  PathResult result;
  Vec3f throughput{1, 1, 1};
  float pdf_bsdf = 0;  // of the direction of `ray`; 0 = from the camera
  Vec3f from;          // the last scattering vertex
  LightPicker picker;  // of that vertex
  int depth = 0, passed = 0;
  bool seen_first = false;

  bool is_shadow = false;
  Vec3f light_radiance;  // waits for the shadow ray
  Ray next;              // waits meanwhile
  bool has_next = false;

  for (;;) {
    RayHit hit;
    ++result.rays;
    const bool found = tracer.trace(ray, is_shadow && !scene.has_transparent, &hit);

    if (is_shadow) {
      bool lit = !found;
      if (found && scene.has_transparent && passed < kMaxPassed) {
        const Surface s = make_surface(scene, ray, hit, {});
        if (s.opacity < 1.0f) {
          light_radiance *= 1.0f - s.opacity;
          ray.o = leave_surface(s.p, s.geometric, ray.d, hit.t);
          ray.tmax -= hit.t;
          ++passed;
          if (ray.tmax > 0) continue;
          lit = true;
        }
      }
      if (lit) result.radiance += light_radiance;
      if (!has_next) return result;
      is_shadow = false;
      passed = 0;
      ray = next;
      continue;
    }

    if (pdf_bsdf > 0 && scene.has_visible_lights) {
      const float reach = found ? hit.t : 1e30f;
      result.radiance += throughput * visible_lights(scene, ray, reach, from, picker, pdf_bsdf);
    }
    if (!found) {
      const Vec3f sky = sky_radiance(scene, ray.d, cone.spread);
      result.radiance += throughput * (depth > 0 ? sky + scene.sky_ambient : sky);
      return result;
    }

    const Surface s = make_surface(scene, ray, hit, cone);
    if (s.opacity < 1.0f && passed < kMaxPassed && sampler.next_1d() >= s.opacity) {
      ray.o = leave_surface(s.p, s.geometric, ray.d, hit.t);
      cone.width += cone.spread * hit.t;
      ++passed;
      continue;
    }
    passed = 0;
    if (!seen_first) {
      seen_first = true;
      result.albedo = s.base_color;
      result.normal = s.normal;
    }
    if (max_component(s.emission) > 0) {
      const Vec3f emitted = surface_emission(s);
      float weight = 1;
      if (pdf_bsdf > 0 && s.instance->light >= 0) {
        const float selected =
            picker.probability(scene, static_cast<uint32_t>(s.instance->light));
        const float pdf =
            lights::instance_pdf(scene, *s.instance, from, s.p, s.geometric, ray.time);
        weight = mis_weight(pdf_bsdf, selected * pdf);
      }
      result.radiance += throughput * emitted * weight;
    }
    if (++depth >= options.max_depth) return result;

    if (depth > options.roulette_depth) {
      const float survive = min(max_component(throughput), 0.95f);
      if (sampler.next_1d() >= survive) return result;
      throughput = throughput / survive;
    }

    const Vec3f wo_W = -ray.d;
    Frame frame;
    const Bsdf bsdf = surface_bsdf(scene, s, wo_W, &frame);
    const Vec3f wo = frame.to_local(wo_W);
    cone.width += cone.spread * hit.t;

    // Next event: one light.
    picker.prepare(scene, s.p, s.geometric);
    const Vec2f choice = sampler.next_2d();  // of the light, of the lobe
    const LightSample light = picker.sample(scene, s.p, choice.x, sampler.next_2d(), ray.time);
    is_shadow = false;
    Ray shadow;
    if (light.pdf > 0 && dot(light.wi, s.geometric) > 0) {
      float pdf = 0;
      const Vec3f f = eval_bsdf(bsdf, wo, frame.to_local(light.wi), &pdf);
      if (max_component(f) > 0) {
        const float weight = light.is_delta ? 1.0f : mis_weight(light.pdf, pdf);
        light_radiance = throughput * f * light.radiance * (weight / light.pdf);
        if (light.casts_shadow) {
          is_shadow = true;
          shadow.o = leave_surface(s.p, s.geometric, light.wi, hit.t);
          shadow.d = light.wi;
          shadow.tmax = light.distance * 0.9999f;
          shadow.time = ray.time;
        } else {
          result.radiance += light_radiance;
        }
      }
    }

    // Next direction. The last segment can only bring light from something that a ray can hit.
    has_next = false;
    if (depth + 1 < options.max_depth || scene.has_emitters) {
      const BsdfSample sample = sample_bsdf(bsdf, wo, choice.y, sampler.next_2d());
      const Vec3f wi = frame.to_world(sample.wi);
      if (sample.pdf > 0 && dot(wi, s.geometric) > 0 && max_component(sample.weight) > 0) {
        throughput *= sample.weight;
        pdf_bsdf = sample.pdf;
        from = s.p;
        // The cone widens with the lobe: texture detail that a broad lobe averages is not sought.
        cone.spread += 0.2f * sqrtf(min(1.0f / (kPi * sample.pdf), 1.0f));
        has_next = true;
        next.o = leave_surface(s.p, s.geometric, wi, hit.t);
        next.d = wi;
        next.tmax = 1e30f;
        next.time = ray.time;
      }
    }
    if (is_shadow) {
      ray = shadow;
    } else if (has_next) {
      ray = next;
    } else {
      return result;
    }
  }
}

}  // namespace gloam
