#pragma once
// Light along rays of the interactive stage that do not begin at the camera. Device-safe.

#include "render/kernel/interactive/air.h"

namespace gloam::interactive {

/// Light that a ray brings, and the first surface that it meets.
template <class F>
struct GatheredOf {
  Vec3Of<F> light;     ///< [cd/m²]
  F distance = 1e30f;  ///< to the first surface [m]
  UintOf<F> first;     ///< instance of that, if there is one
};

/// Parts of the light along a ray that gather() counts, beside that of surfaces, media and sky.
template <class F>
struct GatherOptionsOf {
  /// Light straight from lamps counts, weighted against direct_light() by path->pdf_bsdf. If not,
  /// direct_light() at the ray's origin alone counts it.
  bool counts_lamps = false;
  LampListsOf<F> lists = {};      ///< of the ray's origin
  float near_lamp = 0.0f;         ///< else, distance up to which lamps count nevertheless [m]
  MaskOf<F> flames = false;       ///< lanes in which emission of media counts
  MaskOf<F> near_flames = false;  ///< lanes in which it does within glow::kNearGlow
};

/// Rays on their way to the first surface that is no glass or mirror. All steps are inlined, so
/// that the compiler keeps the state in registers.
template <class F, class Tracer>
class GatherRays {
 public:
  GLOAM_HD GatherRays(const InteractiveWorld<Tracer>& world, const GatherOptionsOf<F>& options,
                      MaskOf<F> active, paths::State<F>* path, CacheRequest* requests)
      : world_(world),
        options_(options),
        path_(*path),
        requests_(requests),
        active_(active),
        flames_(options.flames) {}

  [[gnu::always_inline]] GLOAM_HD GatheredOf<F> trace() {
    for (int event = 0; event < interactive::kMaxEvents && any(active_); ++event) {
      RayHitOf<F> hit;
      path_.result.rays += select(active_, UintOf<F>(1u), UintOf<F>(0u));
      const Mask found = world_.tracer.closest(path_.ray, active_, false, &hit);
      if (event == 0) {
        out_.distance = select(found, hit.t, out_.distance);
        out_.first = hit.instance;
      }
      add_light_before(event, select(found, hit.t, F(1e30f)), found);
      active_ = found;
      if (!any(active_)) break;
      meet_surface(hit);
    }
    return out_;
  }

 private:
  using Mask = MaskOf<F>;

  /// Adds the light of media, lamps and sky before the surface at `tmax`.
  [[gnu::always_inline]] GLOAM_HD void add_light_before(int event, F tmax, Mask found) {
    if (!world_.scene.media.volumes.empty()) cross_air(event, tmax, found);
    if (options_.counts_lamps && world_.scene.has_visible_lights) {
      const Vec3Of<F> lamps = lamps_met(world_, options_.lists, path_, tmax, active_);
      out_.light += select<F>(active_, throughput_ * lamps, Vec3Of<F>{});
    }
    if (const Mask missed = active_ & !found; any(missed)) {
      const Vec3Of<F> sky = sky_radiance_of(world_.scene, path_.ray.d, path_.cone_spread, missed) +
                            in_all_lanes<F>(world_.scene.sky_ambient);
      out_.light += select<F>(missed, throughput_ * sky, Vec3Of<F>{});
    }
  }

  [[gnu::always_inline]] GLOAM_HD void cross_air(int event, F tmax, Mask found) {
    if (event == 0 && world_.scene.has_glow()) {
      each_lane(active_ & options_.near_flames, [&](int i) {
        Ray ray = lane(path_.ray, i);
        ray.tmax = lane(tmax, i);
        set_lane(&out_.light, i, near_glow(world_.scene.media, ray));
      });
    }
    MediaOptionsOf<F> options;
    options.tmax = tmax;
    options.steps = interactive::kGatherSteps;
    options.active = active_;
    options.flames = flames_;
    options.coarser = options_.counts_lamps ? 0 : 2;
    CacheRequest air[Lanes<F>::kCount] = {};
    const MediaLightOf<F> media = cross_media(world_, options, &path_, air);
    out_.light += select<F>(active_, throughput_ * (media.radiance + media.around), Vec3Of<F>{});
    if (world_.scene.has_media()) ask_air(media, found, air);
    throughput_ = select<F>(active_, throughput_ * media.through, throughput_);
  }

  /// Requests the air on the way or the surface, at random by the light that each brings. A ray to
  /// the sky requests the air only as often as it scatters: the direction of a request shapes the
  /// light of its cell, which other rays use too.
  GLOAM_HD void ask_air(const MediaLightOf<F>& media, Mask found, const CacheRequest* air) {
    const F scattered = max_component(media.scattered);
    const F beyond = select(found, max_component(media.through), max(1.0f - scattered, F(0.0f)));
    const F part = scattered / max(scattered + beyond, F(1e-9f));
    const Mask airy = active_ & (path_.sampler.next_1d(active_) < part);
    each_lane(airy & !asked_, [&](int i) { requests_[i] = air[i]; });
    asked_ = asked_ | airy;
  }

  [[gnu::always_inline]] GLOAM_HD void meet_surface(const RayHitOf<F>& hit) {
    const SurfaceOf<F> v = make_surface(world_.scene, path_.ray, hit,
                                        RayConeOf<F>{path_.cone_width, path_.cone_spread}, active_);
    path_.cone_width = path_.cone_width + path_.cone_spread * hit.t;
    if (const Mask shines = active_ & (max_component(v.emission) > 0.0f); any(shines)) {
      add_emission(v, shines, hit.t);
    }
    Mask through = false;
    if (world_.scene.has_transparent) through = choose_passing(v);
    const Vec3Of<F> wo_W = -path_.ray.d;
    FrameOf<F> frame;
    const LayeredBsdfOf<F> bsdf = surface_bsdf(world_.scene, v, wo_W, &frame, active_ & !through);
    const LitSurfaceOf<F> s{v, frame, bsdf, bsdf, frame.to_local(wo_W)};
    // Glass and mirrors show a surface further on.
    const Mask mirror = (!s.bsdf.layered) &
                        (s.bsdf.base.p_layer > interactive::kMirrorProbability) &
                        (v.roughness < interactive::kMaxTracedRoughness);
    const Mask glass =
        active_ & !through &
        (mirror | (s.bsdf.layered & (s.bsdf.p_glass > interactive::kGlassProbability)));
    const Mask matt = active_ & !through & !glass;
    if (any(matt)) add_reflected(s, matt);
    active_ = through;
    if (any(glass)) active_ = follow_glass(s, glass) | through;
    path_.ray.o =
        select<F>(through, leave_surface(v.p, v.geometric, path_.ray.d, hit.t), path_.ray.o);
  }

  [[gnu::always_inline]] GLOAM_HD void add_emission(const SurfaceOf<F>& v, Mask shines, F t) {
    const F pdf =
        paths::emitter_pdf(world_.scene, path_, v, shines & first_, [&](uint32_t row, int i) {
          // Light of lamps to a cell counts where surfaces sample it: no light sampler is prepared
          // there.
          return options_.counts_lamps ? lamp_probability(world_, options_.lists, path_, row, i)
                                       : 1.0f;
        });
    const F weight =
        select(first_ & (pdf > 0.0f),
               options_.counts_lamps ? mis_weight(path_.pdf_bsdf, pdf)
                                     : select(t < options_.near_lamp, F(1.0f), F(0.0f)),
               F(1.0f));
    out_.light += select<F>(shines, throughput_ * v.emission * (v.opacity * weight), Vec3Of<F>{});
  }

  /// Lanes that pass a transparent surface, by chance.
  [[gnu::always_inline]] GLOAM_HD Mask choose_passing(const SurfaceOf<F>& v) {
    const F opacity = opacity_of(v);
    const Mask thin = active_ & (opacity < 1.0f);
    Mask through = false;
    if (any(thin)) through = thin & (path_.sampler.next_1d(thin) >= opacity);
    const Vec3Of<F> weight = select<F>(through, passing_light(v) / (1.0f - opacity),
                                       in_all_lanes<F>({1, 1, 1}) * (v.opacity / opacity));
    throughput_ =
        select<F>(thin & (max_component(v.straight) > 0.0f), throughput_ * weight, throughput_);
    return through;
  }

  /// Adds the light that the surface reflects in the `matt` lanes: of lamps and of the cache.
  [[gnu::always_inline]] GLOAM_HD void add_reflected(const LitSurfaceOf<F>& s, Mask matt) {
    const LayeredBsdfOf<F> shiny = specular_part(s.bsdf);
    LampOptionsOf<F> lamp_options;
    lamp_options.active = matt;
    const LampLightOf<F> lamps =
        direct_light<F>(world_, {s.v, s.frame, s.bsdf, shiny, s.wo}, lamp_options, &path_);
    // Light that is reflected again is a mean over many lookups anyway: there, blurring would only
    // leak.
    Vec3Of<F> jitter = in_all_lanes<F>({0.5f, 0.5f, 0.0f});
    uint32_t coarser = 1;
    if (options_.counts_lamps) {  // in a mirror
      const Vec2Of<F> u = path_.sampler.next_2d(matt);
      jitter = {u.x, u.y, path_.sampler.next_1d(matt)};
      coarser = 0;
    }
    const CachePlaceOf<F> at = place_of(s.v);
    const CacheCellOf<F> cells =
        ask_cells(world_.cache, at, matt & !asked_, jitter, coarser, requests_);
    const Vec3Of<F> cached =
        cached_light(world_.cache, at, cells, matt, coarser, world_.cache.mean);
    F a, b;
    layer_albedo(*world_.scene.albedo, s.v.roughness, s.wo.z, &a, &b);
    const Vec3Of<F> gloss = s.bsdf.base.f0 * a + s.bsdf.base.f90 * b;
    const Vec3Of<F> leaving =
        diffuse_albedo(s.bsdf) * (lamps.diffuse + cached) + gloss * cached + lamps.specular;
    out_.light += select<F>(matt, throughput_ * leaving, Vec3Of<F>{});
  }

  /// Lanes whose ray is reflected or bent by the surface.
  [[gnu::always_inline]] GLOAM_HD Mask follow_glass(const LitSurfaceOf<F>& s, Mask glass) {
    const SurfaceOf<F>& v = s.v;
    const Vec2Of<F> u = path_.sampler.next_2d(glass);
    const BsdfSampleOf<F> sample = sample_bsdf(s.bsdf, s.wo, path_.sampler.next_1d(glass), u);
    const Vec3Of<F> wi = s.frame.to_world(sample.wi);
    const Mask goes = glass & (sample.pdf > 0.0f);
    throughput_ = select<F>(goes, throughput_ * sample.weight, throughput_);
    path_.ray.o = select<F>(goes, leave_surface(v.p, v.geometric, wi, v.t), path_.ray.o);
    path_.ray.d = select<F>(goes, wi, path_.ray.d);
    first_ = first_ & !goes;
    if (options_.counts_lamps) flames_ = flames_ | goes;
    // No light was sampled for this bounce: the light that it meets counts in full.
    path_.pdf_bsdf = select(goes, F(1e12f), path_.pdf_bsdf);
    path_.from = select<F>(goes, v.p, path_.from);
    return goes;
  }

  const InteractiveWorld<Tracer>& world_;
  const GatherOptionsOf<F>& options_;
  paths::State<F>& path_;
  CacheRequest* requests_;
  Mask active_, flames_;
  Mask first_ = true;   ///< lanes whose ray has met neither glass nor mirror yet
  Mask asked_ = false;  ///< lanes that have a request
  Vec3Of<F> throughput_ = in_all_lanes<F>({1, 1, 1});
  GatheredOf<F> out_;
};

/// Light along path->ray in the `active` lanes, from its first surface that is no glass or mirror.
/// `requests`: one per lane.
template <class F, class Tracer>
GLOAM_HD_LARGE GatheredOf<F> gather(const InteractiveWorld<Tracer>& world,
                                    const GatherOptionsOf<F>& options, MaskOf<F> active,
                                    paths::State<F>* path, CacheRequest* requests) {
  return GatherRays<F, Tracer>(world, options, active, path, requests).trace();
}

}  // namespace gloam::interactive
