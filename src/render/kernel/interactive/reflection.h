#pragma once
// Reflection rays of surfaces in view, and the light that they bring. Device-safe.

#include "render/kernel/interactive/gather.h"

namespace gloam {

/// Weights of the light that reflection rays bring.
template <class F>
struct ReflectionUseOf {
  MaskOf<F> goes = false;      ///< lanes that have a ray of their own
  MaskOf<F> together = false;  ///< lanes in quads whose rays serve all four
  MaskOf<F> borrows = false;   ///< lanes of such quads without a ray of their own
  Vec3Of<F> weight;            ///< fraction of the ray's light that gets to the camera
  Vec3Of<F> albedo;            ///< of all light that is reflected
};

/// Rays of reflections, with all that the light along them depends on.
template <class F>
struct ReflectedRayOf {
  RayOf<F> ray;
  F cone_width = 0.0f, cone_spread = 0.0f;  ///< at the surface [m], and along the ray [m/m]
  F pdf = 0.0f;                             ///< of the ray's direction [1/sr]
  MaskOf<F> flames = true;                  ///< the ray shows the emission of media
  Vec3Of<F> from, normal;                   ///< the surface [m], and its geometric normal
  LampListsOf<F> lists;                     ///< lamps of the surface
  SamplerOf<F> sampler;
  using Members =
      MemberList<&ReflectedRayOf::ray, &ReflectedRayOf::cone_width, &ReflectedRayOf::cone_spread,
                 &ReflectedRayOf::pdf, &ReflectedRayOf::flames, &ReflectedRayOf::from,
                 &ReflectedRayOf::normal, &ReflectedRayOf::lists, &ReflectedRayOf::sampler>;
};

/// Reflections of surfaces.
template <class F>
struct ReflectionOf {
  ReflectionUseOf<F> use;
  ReflectedRayOf<F> reflected;
};

/// Light that the rays of the `active` lanes bring [cd/m²].
template <class F, class Tracer>
GLOAM_HD Vec3Of<F> trace_reflection(const InteractiveWorld<Tracer>& world,
                                    const ReflectedRayOf<F>& r, MaskOf<F> active, UintOf<F>* rays,
                                    CacheRequest* requests) {
  paths::State<F> path;
  path.ray = r.ray;
  path.cone_width = r.cone_width;
  path.cone_spread = r.cone_spread;
  path.from = r.from;
  path.pdf_bsdf = r.pdf;
  path.sampler = r.sampler;
  const MaskOf<F> unlisted = active & !r.lists.known;
  if (world.scene.lights.size > interactive::kMaxFastLights && any(unlisted)) {
    // For the probabilities of lamps met.
    interactive::prepare_light_sampler(world.scene, r.from, r.normal, unlisted,
                                       interactive::kGlowAmongLamps, &path.light_sampler);
  }
  interactive::GatherOptionsOf<F> options;
  options.counts_lamps = true;
  options.lists = r.lists;
  options.flames = r.flames;
  options.near_flames = !r.flames;
  const Vec3Of<F> light = interactive::gather(world, options, active, &path, requests).light;
  *rays += path.result.rays;
  return light;
}

/// Light towards the camera when the reflection rays have brought the light `seen`.
template <class F>
GLOAM_HD Vec3Of<F> reflected_light(const ReflectionUseOf<F>& r, const Vec3Of<F>& seen) {
  const Vec3Of<F> own = select<F>(r.goes, seen * r.weight, Vec3Of<F>{});
  if (!any(r.borrows)) return own;
  const auto over = [](F x, F y) { return x / max(y, F(1e-6f)); };
  const Vec3Of<F> irradiance{over(own.x, r.albedo.x), over(own.y, r.albedo.y),
                             over(own.z, r.albedo.z)};
  const Vec3Of<F> lent = quad_sums(select<F>(r.together, irradiance, Vec3Of<F>{}));
  return select<F>(r.borrows, lent * r.albedo, own);
}

}  // namespace gloam
