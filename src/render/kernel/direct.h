#pragma once
// The direct stage: first surfaces, every light with its shadow, constant ambient. No reflections.
// Device-safe.

#include "render/kernel/path.h"

namespace gloam {

/// Scenes with more lights than this draw so many of them by power.
inline constexpr uint32_t kMaxDirectLights = kMaxWeighedLights;

/// `first` (may be null) receives the hit of the first surface that shows; untouched when nothing
/// does. Transparent surfaces are composited front to back.
template <class Tracer>
GLOAM_HD PathResult trace_direct(const SceneView& scene, const Tracer& tracer, Ray ray,
                                 RayCone cone, Sampler sampler, bool* found_first, Surface* first) {
  PathResult result;
  *found_first = false;
  const bool all_lights = scene.lights.size <= kMaxDirectLights;
  const uint32_t light_count = all_lights ? scene.lights.size : kMaxDirectLights;
  float transmittance = 1;  // of the surfaces passed so far
  int passed = 0;

  Surface s;
  LightPicker picker;
  Bsdf bsdf;
  Frame frame;
  Vec3f wo;
  Ray view = ray;
  uint32_t next_light = 0;
  bool is_shadow = false;
  Vec3f light_radiance;
  for (;;) {
    RayHit hit;
    ++result.rays;
    const bool found = tracer.trace(ray, is_shadow && !scene.has_transparent, &hit);
    if (is_shadow) {
      bool lit = !found;
      if (found && scene.has_transparent && passed < kMaxPassed) {
        const Surface blocker = make_surface(scene, ray, hit, {});
        if (blocker.opacity < 1.0f) {
          light_radiance *= 1.0f - blocker.opacity;
          ray.o = leave_surface(blocker.p, blocker.geometric, ray.d, hit.t);
          ray.tmax -= hit.t;
          ++passed;
          continue;
        }
      }
      if (lit) result.radiance += light_radiance;
    } else {
      if (!found) {
        result.radiance += sky_radiance(scene, ray.d, cone.spread) * transmittance;
        return result;
      }
      s = make_surface(scene, ray, hit, cone);
      cone.width += cone.spread * hit.t;
      const Vec3f wo_W = -ray.d;
      bsdf = surface_bsdf(scene, s, wo_W, &frame);
      wo = frame.to_local(wo_W);
      if (!*found_first && s.opacity >= 0.5f) {
        *found_first = true;
        *first = s;
        result.albedo = s.base_color;
        result.normal = s.normal;
      }
      float a, b;
      layer_albedo(*scene.albedo, s.roughness, wo.z, &a, &b);
      const Vec3f albedo = bsdf.diffuse + bsdf.f0 * a + bsdf.f90 * b;
      result.radiance += (surface_emission(s) + albedo * (scene.sky_ambient + scene.sky_mean)) *
                         (transmittance * s.opacity);
      view.o = leave_surface(s.p, s.geometric, ray.d, hit.t);
      next_light = 0;
      if (!all_lights) picker.prepare(scene, s.p, s.geometric);
    }
    is_shadow = false;
    while (!is_shadow && next_light < light_count) {
      const uint32_t index = next_light++;
      float pick = sampler.next_1d();
      const Vec2f u = sampler.next_2d();
      const LightSample light = all_lights ? sample_one_light(scene, index, s.p, pick, u, ray.time)
                                           : picker.sample(scene, s.p, pick, u, ray.time);
      if (!(light.pdf > 0) || dot(light.wi, s.geometric) <= 0) continue;
      float pdf;
      light_radiance = eval_bsdf(bsdf, wo, frame.to_local(light.wi), &pdf) * light.radiance *
                       (transmittance * s.opacity /
                        (light.pdf * (all_lights ? 1.0f : static_cast<float>(kMaxDirectLights))));
      if (max_component(light_radiance) <= 0) continue;
      if (!light.casts_shadow) {
        result.radiance += light_radiance;
        continue;
      }
      is_shadow = true;
      passed = 0;
      ray.o = leave_surface(s.p, s.geometric, light.wi, s.t);
      ray.d = light.wi;
      ray.tmax = light.distance * 0.9999f;
    }
    if (is_shadow) continue;
    transmittance *= 1.0f - s.opacity;
    if (transmittance < 0.004f) return result;
    ray = view;
  }
}

}  // namespace gloam
