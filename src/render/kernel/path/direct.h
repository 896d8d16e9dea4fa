#pragma once
// The direct stage: first surfaces, every light with its shadow; one measured ambient light stands
// for what is reflected and for the sky.
// A state machine like the path stage. Device-safe.

#include "render/kernel/path/path.h"

namespace gloam {

/// Shadow rays of a sample in scenes with a light tree, which takes as many lights. Their samples
/// are stratified: one light in each half of the tree's weight.
inline constexpr uint32_t kTreeShadows = 2;

struct DirectState {
  Ray ray;           ///< to be traced now
  bool any = false;  ///< any hit will do
  PathResult result;
  bool has_first = false;  ///< a surface more opaque than not has been met
  RayHit first;            ///< the camera ray's first hit, if that was it

  bool is_shadow = false;
  uint32_t layers = 0, passed = 0;
  uint32_t next_light = 0;
  Vec3f transmittance{1, 1, 1};  ///< of the surfaces passed so far
  Vec3f passing;                 ///< light that passes the surface met last
  RayCone cone;
  Sampler sampler;
  LightSampler light_sampler;
  Surface s;
  LayeredBsdf bsdf;
  Frame frame;
  Vec3f wo, view_d, light_radiance;
};

GLOAM_HD void direct_start(DirectState* state, const Ray& ray, RayCone cone, Sampler sampler) {
  *state = DirectState{};
  state->ray = ray;
  state->view_d = ray.d;
  state->cone = cone;
  state->sampler = sampler;
}

namespace directs {

/// Light that passes the surface; what glass bends goes straight on here.
GLOAM_HD Vec3f passing_light_of(const SceneView& scene, const Surface& s, Vec3f d) {
  Vec3f passing = passing_light(s);
  if (!scene.has_layers()) return passing;
  const int row = scene.materials[scene.instances[s.instance].material].layers;
  if (row < 0) return passing;
  const MaterialLayers& m = scene.layers[static_cast<uint32_t>(row)];
  if (m.straight || s.transmission <= 0) return passing;
  float cos_t;
  const float cosine = fabsf(dot(s.normal, d));
  const float f =
      m.thin ? fresnel_sheet(cosine, m.ior, &cos_t) : fresnel_dielectric(cosine, m.ior, &cos_t);
  return passing + m.tint * (s.opacity * s.transmission * (1.0f - s.metallic) * (1.0f - f));
}

/// A surface that the view meets: what it gives off, and the ambient light.
GLOAM_HD void meet_surface(const SceneView& scene, DirectState* d, const RayHit& hit) {
  d->s = make_surface(scene, d->ray, hit, d->cone);
  d->cone.width += d->cone.spread * hit.t;
  d->bsdf = surface_bsdf(scene, d->s, -d->ray.d, &d->frame);
  d->wo = d->frame.to_local(-d->ray.d);
  if (!d->has_first && d->s.opacity >= 0.5f) {
    d->has_first = true;
    d->first = hit;
    d->result.albedo = d->s.base_color;
    d->result.normal = d->s.normal;
  }
  if (!kPlainScenes) d->passing = passing_light_of(scene, d->s, d->ray.d);
  ++d->layers;
  float a, b;
  layer_albedo(*scene.albedo, d->s.roughness, d->wo.z, &a, &b);
  const Vec3f albedo = d->bsdf.base.diffuse + d->bsdf.base.f0 * a + d->bsdf.base.f90 * b;
  d->result.radiance +=
      (d->s.emission + albedo * scene.ambient->on(d->s.normal)) * (d->transmittance * d->s.opacity);
  d->next_light = 0;
  if (scene.has_many_lights()) d->light_sampler.prepare(scene, d->s.p, d->s.geometric);
}

/// Sets the shadow ray of the next light that can reach the surface; false when none is left.
GLOAM_HD bool next_shadow(const SceneView& scene, DirectState* d) {
  const bool all = !scene.has_many_lights();
  const uint32_t count = all ? scene.lights.size : kTreeShadows;
  const Surface& s = d->s;
  while (d->next_light < count) {
    const uint32_t index = d->next_light++;
    Vec2f u = d->sampler.next_2d();
    if (!all) u.x = (static_cast<float>(index) + u.x) * (1.0f / static_cast<float>(kTreeShadows));
    const LightSample light = all ? sample_one_light(scene, index, s.p, u, d->ray.time)
                                  : d->light_sampler.sample(scene, s.p, u, d->ray.time);
    if (!(light.pdf > 0) || dot(light.wi, s.geometric) <= 0) continue;
    float pdf;
    const float weight = all ? 1.0f : 1.0f / static_cast<float>(kTreeShadows);
    d->light_radiance = eval_bsdf(d->bsdf, d->wo, d->frame.to_local(light.wi), &pdf) *
                        light.radiance * d->transmittance * (s.opacity * weight / light.pdf);
    if (max_component(d->light_radiance) <= 0) continue;
    if (!light.casts_shadow) {
      d->result.radiance += d->light_radiance;
      continue;
    }
    d->passed = 0;
    aim_shadow_ray(s.p, s.geometric, s.t, light, &d->ray);
    return true;
  }
  return false;
}

}  // namespace directs

/// Takes the hit of state->ray; false when state->result is final. Transparent surfaces are
/// composited front to back. Of the first of them, met(ray, surface, hit) is told.
template <class Met>
GLOAM_HD bool direct_advance(const SceneView& scene, DirectState* d, bool found, const RayHit& hit,
                             const Met& met) {
  ++d->result.rays;
  if (d->is_shadow) {
    if (found && scene.lets_light_through() && d->passed < kMaxPassed) {
      const Surface blocker = make_surface(scene, d->ray, hit, {});
      if (const Vec3f passing = directs::passing_light_of(scene, blocker, d->ray.d);
          max_component(passing) > 0.0f) {
        d->light_radiance *= passing;
        d->ray.o = leave_surface(blocker.p, blocker.geometric, d->ray.d, hit.t);
        d->ray.tmax -= hit.t;
        ++d->passed;
        if (d->ray.tmax > 0) return true;
        found = false;
      }
    }
    if (!found) d->result.radiance += d->light_radiance;
  } else {
    if (!found) {
      d->result.radiance += sky_radiance(scene, d->ray.d, d->cone.spread) * d->transmittance;
      return false;
    }
    const Ray ray = d->ray;
    directs::meet_surface(scene, d, hit);
    if (d->layers == 1) met(ray, d->s, hit);
  }
  d->is_shadow = directs::next_shadow(scene, d);
  d->any = d->is_shadow && !scene.lets_light_through();
  if (d->is_shadow) return true;
  if (kPlainScenes) return false;
  d->transmittance *= d->passing;
  if (max_component(d->transmittance) < 0.004f || d->layers >= kMaxPassed) return false;
  d->ray.o = leave_surface(d->s.p, d->s.geometric, d->view_d, d->s.t);
  d->ray.d = d->view_d;
  d->ray.tmax = 1e30f;
  return true;
}

}  // namespace gloam
