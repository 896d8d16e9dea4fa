#pragma once
// The fast stage: first surfaces with direct light of every lamp, one specular bounce, and indirect
// light from the irradiance cache. What is noisy comes out apart, for the filter. Device-safe.

#include "render/kernel/realtime/fast_gather.h"

namespace gloam {

/// Lanes that send out rays for others of their quad too, where that will do.
template <class F>
struct FastTurnsOf {
  MaskOf<F> of_two = true;   ///< one of each pair side by side
  MaskOf<F> of_four = true;  ///< one of each quad
};

/// Weights of the light that reflection rays bring.
template <class F>
struct ReflectionUseOf {
  MaskOf<F> goes = false;      ///< lanes that have a ray of their own
  MaskOf<F> together = false;  ///< in quads that share what they have,
  MaskOf<F> borrows = false;   ///< and have none
  Vec3Of<F> weight;            ///< fraction of the ray's light that gets to the camera
  Vec3Of<F> albedo;            ///< of all light that is reflected
};

/// Rays from surfaces that reflect.
template <class F>
struct ReflectionOf {
  ReflectionUseOf<F> use;
  RayOf<F> ray;
  F cone_width = 0.0f, cone_spread = 0.0f;
  F pdf = 0.0f;             ///< of the ray's direction
  MaskOf<F> flames = true;  ///< the ray shows what glows
  Vec3Of<F> from, normal;   ///< the surface, and its geometric normal
  SamplerOf<F> sampler;
};

/// The ray of lane i of `from` into lane k of `to`.
template <class F>
GLOAM_HD void copy_lane(const ReflectionOf<F>& from, int i, ReflectionOf<F>* to, int k) {
  set_lane(&to->ray.o, k, lane(from.ray.o, i));
  set_lane(&to->ray.d, k, lane(from.ray.d, i));
  set_lane(&to->ray.time, k, lane(from.ray.time, i));
  set_lane(&to->cone_width, k, lane(from.cone_width, i));
  set_lane(&to->cone_spread, k, lane(from.cone_spread, i));
  set_lane(&to->pdf, k, lane(from.pdf, i));
  set_lane(&to->flames, k, lane(from.flames, i));
  set_lane(&to->from, k, lane(from.from, i));
  set_lane(&to->normal, k, lane(from.normal, i));
  to->sampler.take_lane(k, from.sampler, i);
}

/// Result of one camera ray; its radiance is base + air + through (albedo (direct + cached) +
/// cached gloss + specular + the light of its reflection ray).
template <class F>
struct FastSampleOf {
  Vec3Of<F> base;     ///< [cd/m²], with its edges
  Vec3Of<F> air;      ///< light that media scatter [cd/m²]: noise of few samples
  Vec3Of<F> through;  ///< fraction of the first solid surface's light that gets to the camera
  MaskOf<F> solid = false;
  RayHitOf<F> hit;      ///< of that surface; t: distance from the camera
  Vec3Of<F> p, normal;  ///< where it is, world [m], and its shading normal
  F roughness = 0.0f;
  Vec3Of<F> albedo;    ///< diffuse
  Vec3Of<F> gloss;     ///< directional albedo of what reflects the cache's light
  Vec3Of<F> direct;    ///< diffuse light of lamps over `albedo` [cd/m²]
  Vec3Of<F> specular;  ///< of lamps [cd/m²]
  ReflectionOf<F> reflection;
  F near = 0.0f;  ///< 1 where one direction meets something less than a cell's edge away
  UintOf<F> rays = 0u;
};

/// Light that the rays of the `active` lanes bring [cd/m²].
template <class F, class Tracer>
GLOAM_HD Vec3Of<F> look_along(const SceneView& scene, const Tracer& tracer,
                              const IrradianceCacheView& cache, const ReflectionOf<F>& r,
                              MaskOf<F> active, UintOf<F>* rays, CacheRequest* requests) {
  paths::State<F> path;
  path.ray = r.ray;
  path.cone_width = r.cone_width;
  path.cone_spread = r.cone_spread;
  path.from = r.from;
  path.pdf_bsdf = r.pdf;
  path.sampler = r.sampler;
  if (scene.lights.size > kMaxFastLights) {  // for the chances of lamps that are met
    fasts::prepare_light_sampler(scene, r.from, r.normal, active, fasts::kGlowAmongLamps,
                                 &path.light_sampler);
  }
  const Vec3Of<F> light =
      fasts::gather(scene, tracer, cache, true, 0.0f, r.flames, !r.flames, active, &path, requests)
          .light;
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

/// The camera ray's picture, but for what FastSampleOf::reflection will bring. `near_u` in [0, 1)²:
/// the direction of FastSampleOf::near. `requests`: kFastRequests per lane, for the first solid
/// surface, what panes in front reflect, such a pane, the air. Lanes come in quads.
inline constexpr int kFastRequests = 4;
template <class F, class Tracer>
GLOAM_HD FastSampleOf<F> trace_fast(const SceneView& scene, const Tracer& tracer,
                                    const IrradianceCacheView& cache, const RayOf<F>& ray,
                                    F cone_width, F cone_spread, const SamplerOf<F>& sampler,
                                    Vec2Of<F> near_u, const FastTurnsOf<F>& turns, MaskOf<F> active,
                                    CacheRequest* requests) {
  using Mask = MaskOf<F>;
  FastSampleOf<F> out;
  out.through = in_all_lanes<F>({1, 1, 1});
  paths::State<F> path;
  path.ray = ray;
  path.cone_width = cone_width;
  path.cone_spread = cone_spread;
  path.sampler = sampler;
  const bool every = scene.lights.size <= kMaxFastLights;
  F way = 0.0f;
  for (uint32_t passed = 0; passed < kMaxPassed && any(active); ++passed) {
    RayHitOf<F> hit;
    path.result.rays += select(active, UintOf<F>(1u), UintOf<F>(0u));
    const Mask found = tracer.closest(path.ray, active, passed == 0, &hit);
    if (!scene.media.volumes.empty()) {
      constexpr int kSteps = 8;
      const F tmax = select(found, hit.t, F(1e30f));
      const Mask borrows =
          even_quads<F>(active, select(found, hit.instance + 1u, UintOf<F>(0u)), path.ray.d) &
          !turns.of_two;
      const Mask samples = active & !borrows & Mask(cache.lamps_move);
      const auto media = fasts::cross_media(scene, tracer, cache, tmax, active, samples, kSteps, 0,
                                            true, &path, requests + 3 * Lanes<F>::kCount);
      const Vec3Of<F> lamps = select<F>(borrows, flip<1>(media.lamps), media.lamps);
      out.base += select<F>(active, out.through * media.radiance, Vec3Of<F>{});
      out.air += select<F>(active, out.through * (media.around + lamps), Vec3Of<F>{});
      out.through = select<F>(active, out.through * media.through, out.through);
    }
    if (const Mask missed = active & !found; any(missed)) {
      each_lane(missed, [&](int i) {
        const Vec3f sky = sky_radiance(scene, lane(path.ray.d, i), lane(path.cone_spread, i));
        set_lane(&out.base, i, lane(out.base, i) + lane(out.through, i) * sky);
      });
    }
    active = found;
    if (!any(active)) break;
    const SurfaceOf<F> v =
        make_surface(scene, path.ray, hit, RayConeOf<F>{path.cone_width, path.cone_spread}, active);
    path.cone_width = path.cone_width + path.cone_spread * hit.t;
    way += hit.t;
    const Vec3Of<F> wo_W = -path.ray.d;
    FrameOf<F> frame;
    const LayeredBsdfOf<F> bsdf = surface_bsdf(scene, v, wo_W, &frame, active);
    const LayeredBsdfOf<F> shiny = fasts::specular_part(bsdf);
    const Vec3Of<F> wo = frame.to_local(wo_W);
    const Vec3Of<F> passing = scene.has_transparent ? passing_light(v) : Vec3Of<F>{};
    const Mask solid = active & !(max_component(passing) > 0.0f);
    const Mask glass = bsdf.layered & (bsdf.p_glass > 0.0f);
    const Mask traced =
        active & (glass | ((v.roughness < kMaxTracedRoughness) & (bsdf.base.p_layer > 0.0f)) |
                  (bsdf.layered & (bsdf.p_coat > 0.0f)));
    Vec3Of<F> diffuse, specular;
    const Mask borrows = even_quads<F>(solid, hit.instance, v.normal) & !turns.of_two;
    fasts::direct_light(scene, tracer, &path, v, shiny, frame, wo, traced, active, borrows, every,
                        kSampledLights, &diffuse, &specular);
    const Vec2Of<F> u = path.sampler.next_2d(active);
    const Vec3Of<F> jitter{u.x, u.y, path.sampler.next_1d(active)};
    const Mask pane = active & !solid;
    CacheRequest asked[Lanes<F>::kCount];
    const fasts::CachePlaceOf<F> at = fasts::place_of(v);
    const CacheCellOf<F> cells = fasts::ask_cells(cache, at, active, jitter, 0, asked);
    // Light of the first solid surface is looked up later, when its cells have been traced.
    const Vec3Of<F> cached = fasts::cached_light(cache, at, cells, pane, 0, cache.mean);
    if (any(solid)) {
      const Vec3Of<F> out_W =
          FrameOf<F>::from_z(v.normal).to_world(sample_cosine_hemisphere(near_u));
      RayOf<F> near = path.ray;
      near.o = leave_surface(v.p, v.geometric, v.geometric, v.t);
      near.d = out_W;
      near.tmax = cells.edge;
      const Mask goes = solid & !borrows;
      path.result.rays += select(goes, UintOf<F>(1u), UintOf<F>(0u));
      const F met = select(tracer.occluded(near, goes), F(1.0f), F(0.0f));
      out.near = select(solid, select(borrows, flip<1>(met), met), out.near);
    }
    const Vec3Of<F> albedo = fasts::diffuse_albedo(bsdf);
    F a, b;
    layer_albedo(*scene.albedo, v.roughness, wo.z, &a, &b);
    const Vec3Of<F> reflected = bsdf.base.f0 * a + bsdf.base.f90 * b;
    const Vec3Of<F> gloss = select<F>(traced, Vec3Of<F>{}, reflected);
    // Request of one of several panes, by chance.
    const F chosen = passed == 0 ? F(0.0f) : path.sampler.next_1d(pane);
    const Mask one = solid | (pane & (chosen * static_cast<float>(passed + 1) < 1.0f));
    each_lane(one,
              [&](int i) { requests[lane(solid, i) ? i : 2 * Lanes<F>::kCount + i] = asked[i]; });

    if (any(traced)) {
      const Vec2Of<F> toss = path.sampler.next_2d(traced);
      const F pick = path.sampler.next_1d(traced);
      const BsdfSampleOf<F> s = sample_bsdf(shiny, wo, pick, toss);
      const Vec3Of<F> wi = frame.to_world(s.wi);
      const Mask can_share =
          traced & solid & !bsdf.layered & (v.roughness >= kLeastSharedRoughness);
      ReflectionOf<F> r;
      ReflectionUseOf<F>& use = r.use;
      use.together = even_quads<F>(can_share, hit.instance, v.normal);
      use.borrows = use.together & !turns.of_four;
      use.goes = traced & !use.borrows & (s.pdf > 0.0f) & (max_component(s.weight) > 0.0f);
      r.ray = path.ray;
      r.ray.o = leave_surface(v.p, v.geometric, wi, v.t);
      r.ray.d = wi;
      r.cone_width = path.cone_width;
      r.cone_spread = path.cone_spread + 0.2f * square_root(min(1.0f / (kPi * s.pdf), F(1.0f)));
      r.pdf = s.pdf;
      r.flames = !fasts::blurs_flames(v, shiny);
      r.from = v.p;
      r.normal = v.geometric;
      r.sampler = path.sampler;
      use.weight = s.weight;
      use.albedo = reflected;
      if (const Mask now = use.goes & pane; any(now)) {
        specular += select<F>(now,
                              s.weight * look_along(scene, tracer, cache, r, now, &path.result.rays,
                                                    requests + Lanes<F>::kCount),
                              Vec3Of<F>{});
      }
      use.goes = use.goes & solid;
      if (passed == 0) {
        out.reflection = r;
      } else {
        ReflectionUseOf<F>& all = out.reflection.use;
        each_lane(solid, [&](int i) { copy_lane(r, i, &out.reflection, i); });
        all.weight = select<F>(solid, use.weight, all.weight);
        all.albedo = select<F>(solid, use.albedo, all.albedo);
        all.goes = all.goes | use.goes;
        all.together = all.together | use.together;
        all.borrows = all.borrows | use.borrows;
      }
    }
    const Vec3Of<F> shade = albedo * (diffuse + cached) + gloss * cached + specular;
    out.base += out.through * select<F>(active, v.emission * v.opacity, Vec3Of<F>{});
    out.base += out.through * select<F>(pane, shade * v.opacity, Vec3Of<F>{});
    out.solid = out.solid | solid;
    out.p = select<F>(solid, v.p, out.p);
    out.normal = select<F>(solid, v.normal, out.normal);
    out.roughness = select(solid, v.roughness, out.roughness);
    out.hit.instance = select(solid, hit.instance, out.hit.instance);
    out.hit.primitive = select(solid, hit.primitive, out.hit.primitive);
    out.hit.u = select(solid, hit.u, out.hit.u);
    out.hit.v = select(solid, hit.v, out.hit.v);
    out.hit.t = select(solid, way, out.hit.t);
    out.albedo = select<F>(solid, albedo, out.albedo);
    out.gloss = select<F>(solid, gloss, out.gloss);
    out.direct = select<F>(solid, diffuse, out.direct);
    out.specular = select<F>(solid, specular, out.specular);
    out.through = select<F>(pane, out.through * passing, out.through);
    active = pane & (max_component(out.through) > 0.004f);
    path.ray.o = select<F>(active, leave_surface(v.p, v.geometric, path.ray.d, hit.t), path.ray.o);
  }
  out.rays = path.result.rays;
  return out;
}

}  // namespace gloam
