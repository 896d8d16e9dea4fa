#pragma once
// The fast stage: light along rays that do not begin at the camera. Device-safe.

#include "render/kernel/realtime/fast_air.h"

namespace gloam::fasts {

/// Light that a ray brings, and the first surface that it meets.
template <class F>
struct GatheredOf {
  Vec3Of<F> light;  ///< [cd/m²]
  F way = 1e30f;    ///< to the first surface [m]
  UintOf<F> first;  ///< instance of that, if there is one
};

/// Light along path->ray in the `active` lanes, from its first surface that is no glass or mirror.
/// Light that comes straight from lamps is weighted against direct_light() by path->pdf_bsdf if
/// `count_lamps`; if not, direct_light() at the ray's origin alone counts it, save that of lamps
/// nearer than `near_lamp` [m]. `flames`: lanes in which emission of media counts, `near`: or
/// counts within glow::kNearGlow.
template <class F, class Tracer>
GLOAM_HD GatheredOf<F> gather(const SceneView& scene, const Tracer& tracer,
                              const IrradianceCacheView& cache, bool count_lamps, float near_lamp,
                              MaskOf<F> flames, MaskOf<F> near, MaskOf<F> active,
                              paths::State<F>* path, CacheRequest* requests) {
  constexpr int kMaxEvents = 5;  // in and out of two glasses
  GatheredOf<F> out;
  Vec3Of<F>&sum = out.light, throughput = in_all_lanes<F>({1, 1, 1});
  const bool every = scene.lights.size <= kMaxFastLights;
  MaskOf<F> first = true, asked = false;
  for (int event = 0; event < kMaxEvents && any(active); ++event) {
    RayHitOf<F> hit;
    path->result.rays += select(active, UintOf<F>(1u), UintOf<F>(0u));
    const MaskOf<F> found = tracer.closest(path->ray, active, false, &hit);
    if (event == 0) {
      out.way = select(found, hit.t, out.way);
      out.first = hit.instance;
    }
    if (!scene.media.volumes.empty()) {
      constexpr int kSteps = 4;
      const F tmax = select(found, hit.t, F(1e30f));
      if (event == 0 && scene.has_glow()) {
        each_lane(active & near, [&](int i) {
          Ray ray = lane(path->ray, i);
          ray.tmax = lane(tmax, i);
          set_lane(&sum, i, near_glow(scene.media, ray));
        });
      }
      CacheRequest air[Lanes<F>::kCount] = {};
      const MediaLightOf<F> media = cross_media(scene, tracer, cache, tmax, active, false, kSteps,
                                                count_lamps ? 0 : 2, flames, path, air);
      sum += select<F>(active, throughput * (media.radiance + media.around), Vec3Of<F>{});
      // Request of what brings more light: the air on the way, or the surface.
      const MaskOf<F> airy =
          active & ((!found) | (max_component(media.scattered) > max_component(media.through)));
      each_lane(airy & !asked, [&](int i) { requests[i] = air[i]; });
      asked = asked | airy;
      throughput = select<F>(active, throughput * media.through, throughput);
    }
    if (count_lamps && scene.has_visible_lights) {
      const Vec3Of<F> lamps = lamps_met(scene, *path, select(found, hit.t, F(1e30f)), active);
      sum += select<F>(active, throughput * lamps, Vec3Of<F>{});
    }
    if (const MaskOf<F> missed = active & !found; any(missed)) {
      const Vec3Of<F> sky = sky_radiance_of(scene, path->ray.d, path->cone_spread, missed) +
                            in_all_lanes<F>(scene.sky_ambient);
      sum += select<F>(missed, throughput * sky, Vec3Of<F>{});
    }
    active = found;
    if (!any(active)) break;
    SurfaceOf<F> v = make_surface(scene, path->ray, hit,
                                  RayConeOf<F>{path->cone_width, path->cone_spread}, active);
    path->cone_width = path->cone_width + path->cone_spread * hit.t;
    if (const MaskOf<F> shines = active & (max_component(v.emission) > 0.0f); any(shines)) {
      const F pdf = paths::emitter_pdf(scene, *path, v, shines & first, [&](uint32_t row, int i) {
        // Light of lamps to a cell counts where surfaces sample it: no light sampler is prepared
        // there.
        return count_lamps ? chance_of(scene, *path, row, every, kSampledLights, i) : 1.0f;
      });
      const F weight = select(first & (pdf > 0.0f),
                              count_lamps ? mis_weight(path->pdf_bsdf, pdf)
                                          : select(hit.t < near_lamp, F(1.0f), F(0.0f)),
                              F(1.0f));
      sum += select<F>(shines, throughput * v.emission * (v.opacity * weight), Vec3Of<F>{});
    }
    MaskOf<F> through = false;
    if (scene.has_transparent) {
      const F opacity = opacity_of(v);
      const MaskOf<F> thin = active & (opacity < 1.0f);
      if (any(thin)) through = thin & (path->sampler.next_1d(thin) >= opacity);
      const Vec3Of<F> weight = select<F>(through, passing_light(v) / (1.0f - opacity),
                                         in_all_lanes<F>({1, 1, 1}) * (v.opacity / opacity));
      throughput =
          select<F>(thin & (max_component(v.straight) > 0.0f), throughput * weight, throughput);
    }
    const Vec3Of<F> wo_W = -path->ray.d;
    FrameOf<F> frame;
    const LayeredBsdfOf<F> bsdf = surface_bsdf(scene, v, wo_W, &frame, active & !through);
    const Vec3Of<F> wo = frame.to_local(wo_W);
    // Glass and mirrors show a surface further on.
    const MaskOf<F> mirror =
        (!bsdf.layered) & (bsdf.base.p_layer > 0.8f) & (v.roughness < kMaxTracedRoughness);
    const MaskOf<F> glass = active & !through & (mirror | (bsdf.layered & (bsdf.p_glass > 0.3f)));
    const MaskOf<F> matt = active & !through & !glass;
    if (any(matt)) {
      const LayeredBsdfOf<F> shiny = specular_part(bsdf);
      Vec3Of<F> diffuse, specular;
      direct_light<F>(scene, tracer, path, v, shiny, frame, wo, false, matt, false, false, 1,
                      &diffuse, &specular);
      // Light that goes on is a mean over many lookups anyway: there, blurring would only leak.
      Vec3Of<F> jitter = in_all_lanes<F>({0.5f, 0.5f, 0.0f});
      uint32_t coarser = 1;
      if (count_lamps) {  // in a mirror
        const Vec2Of<F> u = path->sampler.next_2d(matt);
        jitter = {u.x, u.y, path->sampler.next_1d(matt)};
        coarser = 0;
      }
      const CachePlaceOf<F> at = place_of(v);
      const CacheCellOf<F> cells = ask_cells(cache, at, matt & !asked, jitter, coarser, requests);
      const Vec3Of<F> cached = cached_light(cache, at, cells, matt, coarser, cache.mean);
      F a, b;
      layer_albedo(*scene.albedo, v.roughness, wo.z, &a, &b);
      const Vec3Of<F> gloss = bsdf.base.f0 * a + bsdf.base.f90 * b;
      const Vec3Of<F> leaving =
          diffuse_albedo(bsdf) * (diffuse + cached) + gloss * cached + specular;
      sum += select<F>(matt, throughput * leaving, Vec3Of<F>{});
    }
    if (any(glass)) {
      const Vec2Of<F> u = path->sampler.next_2d(glass);
      const BsdfSampleOf<F> s = sample_bsdf(bsdf, wo, path->sampler.next_1d(glass), u);
      const Vec3Of<F> wi = frame.to_world(s.wi);
      const MaskOf<F> goes = glass & (s.pdf > 0.0f);
      throughput = select<F>(goes, throughput * s.weight, throughput);
      path->ray.o = select<F>(goes, leave_surface(v.p, v.geometric, wi, v.t), path->ray.o);
      path->ray.d = select<F>(goes, wi, path->ray.d);
      first = first & !goes;
      if (count_lamps) flames = flames | goes;
      // No light was sampled for this bounce: what it meets counts in full.
      path->pdf_bsdf = select(goes, F(1e12f), path->pdf_bsdf);
      path->from = select<F>(goes, v.p, path->from);
      active = goes | through;
    } else {
      active = through;
    }
    path->ray.o =
        select<F>(through, leave_surface(v.p, v.geometric, path->ray.d, hit.t), path->ray.o);
  }
  return out;
}

}  // namespace gloam::fasts
