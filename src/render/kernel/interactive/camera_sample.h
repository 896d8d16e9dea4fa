#pragma once
// Camera rays of the interactive stage: first surfaces with direct light of every lamp, one
// specular bounce, and indirect light from the irradiance cache. Noisy parts come out apart, for
// the filter. Device-safe.

#include "render/kernel/interactive/reflection.h"

namespace gloam {

/// Lanes that trace rays for others of their quad too, where that will do.
template <class F>
struct QuadLeadersOf {
  MaskOf<F> of_pair = true;  ///< one of each pair side by side
  MaskOf<F> of_quad = true;  ///< one of each quad
};

/// Camera rays of a block of pixels. Lanes come in quads.
template <class F>
struct InteractivePixelsOf {
  RayOf<F> ray;
  RayConeOf<F> cone;
  SamplerOf<F> sampler;
  Vec2Of<F> near_u;  ///< in [0, 1)²: the direction of InteractiveSampleOf::near
  QuadLeadersOf<F> leaders;
  MaskOf<F> active = true;
};

/// Result of one camera ray; its radiance is base + air + through (albedo (direct + cached) +
/// cached gloss + specular + the light of its reflection ray).
template <class F>
struct InteractiveSampleOf {
  Vec3Of<F> base;     ///< [cd/m²], with its edges
  Vec3Of<F> air;      ///< light that media scatter [cd/m²]: noise of few samples
  Vec3Of<F> through;  ///< fraction of the first solid surface's light that gets to the camera
  MaskOf<F> solid = false;
  RayHitOf<F> hit;      ///< of that surface; t: distance from the camera
  Vec3Of<F> p, normal;  ///< its place in the world [m], and its shading normal
  F roughness = 0.0f;
  Vec3Of<F> albedo;    ///< diffuse
  Vec3Of<F> gloss;     ///< directional albedo of the part that reflects the cache's light
  Vec3Of<F> direct;    ///< diffuse light of lamps over `albedo` [cd/m²]
  Vec3Of<F> specular;  ///< of lamps [cd/m²]
  ReflectionOf<F> reflection;
  F near = 0.0f;  ///< 1 where one direction meets a surface less than a cell's edge away
  UintOf<F> rays = 0u;
};

/// Requests of a camera ray per lane: for the first solid surface, for reflections of panes in
/// front, for such a pane, for the air, for the lamps of a surface. Each kind has
/// Lanes<F>::kCount in a row.
enum InteractiveRequest {
  kSolidRequest,
  kReflectionRequest,
  kPaneRequest,
  kAirRequest,
  kLampRequest,
  kRequests
};

namespace interactive {

/// Camera rays of a block of pixels on their way through air and panes to the first solid surface.
template <class F, class Tracer>
class CameraRays {
 public:
  GLOAM_HD CameraRays(const InteractiveWorld<Tracer>& world, const InteractivePixelsOf<F>& pixels,
                      CacheRequest* requests, InteractiveSampleOf<F>* out)
      : world_(world), pixels_(pixels), requests_(requests), out_(*out), active_(pixels.active) {
    out_.through = in_all_lanes<F>({1, 1, 1});
    path_.ray = pixels.ray;
    path_.cone_width = pixels.cone.width;
    path_.cone_spread = pixels.cone.spread;
    path_.sampler = pixels.sampler;
  }

  /// Traces the rays. The light of InteractiveSampleOf::reflection is not in the result yet.
  GLOAM_HD void trace() {
    for (; passed_ < kMaxPassed && any(active_); ++passed_) {
      RayHitOf<F> hit;
      path_.result.rays += select(active_, UintOf<F>(1u), UintOf<F>(0u));
      const Mask found = world_.tracer.closest(path_.ray, active_, passed_ == 0, &hit);
      if (!world_.scene.media.volumes.empty()) cross_air(found, hit);
      if (const Mask missed = active_ & !found; any(missed)) add_sky(missed);
      active_ = found;
      if (!any(active_)) break;
      const Vec3Of<F> wo_W = -path_.ray.d;
      const SurfaceOf<F> v = make_surface(
          world_.scene, path_.ray, hit, RayConeOf<F>{path_.cone_width, path_.cone_spread}, active_);
      FrameOf<F> frame;
      const LayeredBsdfOf<F> bsdf = surface_bsdf(world_.scene, v, wo_W, &frame, active_);
      const LayeredBsdfOf<F> shiny = specular_part(bsdf);
      Vertex at{hit, {v, frame, bsdf, shiny, frame.to_local(wo_W)}};
      meet_surface(&at);
      sample_lamps(&at);
      look_up_cache(&at);
      if (any(at.traced)) reflect(&at);
      compose(at);
      pass_panes(at);
    }
    out_.rays = path_.result.rays;
  }

 private:
  using Mask = MaskOf<F>;
  static constexpr int kLanes = Lanes<F>::kCount;

  /// Surface that the rays have met, and its light.
  struct Vertex {
    const RayHitOf<F>& hit;
    LitSurfaceOf<F> surface;
    Vec3Of<F> passing{};              ///< transmittance of panes
    Mask solid{}, pane{};             ///< opaque, and not
    Mask traced{};                    ///< a ray shows the reflection
    Mask borrows{};                   ///< lanes that take shadow rays' results of the lane beside
    LampListsOf<F> lists{};           ///< its lamps
    LampLightOf<F> lamps{};           ///< direct light
    Vec3Of<F> cached{};               ///< indirect light on panes [cd/m²]
    Vec3Of<F> reflected{};            ///< directional albedo of the specular part
    CacheRequest asked[kLanes] = {};  ///< by lane
  };

  GLOAM_HD void cross_air(Mask found, const RayHitOf<F>& hit) {
    MediaOptionsOf<F> options;
    options.tmax = select(found, hit.t, F(1e30f));
    options.steps = interactive::kCameraSteps;
    options.active = active_;
    const Mask borrows =
        even_quads<F>(active_, select(found, hit.instance + 1u, UintOf<F>(0u)), path_.ray.d) &
        !pixels_.leaders.of_pair;
    options.samples_lamps = active_ & !borrows & Mask(world_.cache.lamps_move);
    const auto media = cross_media(world_, options, &path_, requests_ + kAirRequest * kLanes);
    const Vec3Of<F> lamps = select<F>(borrows, flip<1>(media.lamps), media.lamps);
    out_.base += select<F>(active_, out_.through * media.radiance, Vec3Of<F>{});
    out_.air += select<F>(active_, out_.through * (media.around + lamps), Vec3Of<F>{});
    out_.through = select<F>(active_, out_.through * media.through, out_.through);
  }

  GLOAM_HD void add_sky(Mask missed) {
    each_lane(missed, [&](int i) {
      const Vec3f sky =
          sky_radiance(world_.scene, lane(path_.ray.d, i), lane(path_.cone_spread, i));
      set_lane(&out_.base, i, lane(out_.base, i) + lane(out_.through, i) * sky);
    });
  }

  GLOAM_HD void meet_surface(Vertex* at) {
    path_.cone_width = path_.cone_width + path_.cone_spread * at->hit.t;
    distance_ += at->hit.t;
    const LitSurfaceOf<F>& s = at->surface;
    at->passing = world_.scene.has_transparent ? passing_light(s.v) : Vec3Of<F>{};
    at->solid = active_ & !(max_component(at->passing) > 0.0f);
    at->pane = active_ & !at->solid;
    const Mask glass = s.bsdf.layered & (s.bsdf.p_glass > 0.0f);
    at->traced =
        active_ &
        (glass |
         ((s.v.roughness < interactive::kMaxTracedRoughness) & (s.bsdf.base.p_layer > 0.0f)) |
         (s.bsdf.layered & (s.bsdf.p_coat > 0.0f)));
    at->borrows = even_quads<F>(at->solid, at->hit.instance, s.v.normal) & !pixels_.leaders.of_pair;
  }

  /// Finds the surface's list of lamps, and asks for it.
  GLOAM_HD void look_up_lamps(Vertex* at) {
    if (world_.lamps == nullptr) return;
    CachePlaceOf<F> place = place_of(at->surface.v);
    place.n = at->surface.v.geometric;
    CacheRequest asked[kLanes] = {};
    ask_cells(*world_.lamps, place, active_, in_all_lanes<F>({0.5f, 0.5f, 0.0f}), 0, asked);
    each_lane(active_, [&](int i) {
      const int row = find_cell(*world_.lamps, asked[i].key);
      if (row >= 0) at->lists.set(i, &world_.lamps->lists[static_cast<uint32_t>(row)]);
      requests_[kLampRequest * kLanes + i] = asked[i];
    });
  }

  GLOAM_HD void sample_lamps(Vertex* at) {
    look_up_lamps(at);
    LampOptionsOf<F> options;
    options.active = active_;
    options.lists = at->lists;
    options.traced = at->traced;
    options.borrows = at->borrows;
    options.every = world_.scene.lights.size <= interactive::kMaxFastLights;
    options.samples = interactive::kSampledLights;
    at->lamps = direct_light(world_, at->surface, options, &path_);
  }

  GLOAM_HD void look_up_cache(Vertex* at) {
    const SurfaceOf<F>& v = at->surface.v;
    const Vec2Of<F> u = path_.sampler.next_2d(active_);
    const Vec3Of<F> jitter{u.x, u.y, path_.sampler.next_1d(active_)};
    const CachePlaceOf<F> place = place_of(v);
    const CacheCellOf<F> cells = ask_cells(world_.cache, place, active_, jitter, 0, at->asked);
    // Light of the first solid surface is looked up later, when its cells have been traced.
    at->cached = cached_light(world_.cache, place, cells, at->pane, 0, world_.cache.mean);
    if (any(at->solid)) find_near(*at, cells.edge);
    F a, b;
    layer_albedo(*world_.scene.albedo, v.roughness, at->surface.wo.z, &a, &b);
    at->reflected = at->surface.bsdf.base.f0 * a + at->surface.bsdf.base.f90 * b;
    // Request of one of several panes, by chance.
    const F chosen = passed_ == 0 ? F(0.0f) : path_.sampler.next_1d(at->pane);
    const Mask one = at->solid | (at->pane & (chosen * static_cast<float>(passed_ + 1) < 1.0f));
    each_lane(one, [&](int i) {
      requests_[lane(at->solid, i) ? i : kPaneRequest * kLanes + i] = at->asked[i];
    });
  }

  /// Whether something is less than `edge` away in one direction.
  GLOAM_HD void find_near(const Vertex& at, F edge) {
    const SurfaceOf<F>& v = at.surface.v;
    RayOf<F> near = path_.ray;
    near.o = leave_surface(v.p, v.geometric, v.geometric, v.t);
    near.d = FrameOf<F>::from_z(v.normal).to_world(sample_cosine_hemisphere(pixels_.near_u));
    near.tmax = edge;
    const Mask goes = at.solid & !at.borrows;
    path_.result.rays += select(goes, UintOf<F>(1u), UintOf<F>(0u));
    const F met = select(world_.tracer.occluded(near, goes), F(1.0f), F(0.0f));
    out_.near = select(at.solid, select(at.borrows, flip<1>(met), met), out_.near);
  }

  GLOAM_HD void reflect(Vertex* at) {
    const LitSurfaceOf<F>& s = at->surface;
    const SurfaceOf<F>& v = s.v;
    const Vec2Of<F> u = path_.sampler.next_2d(at->traced);
    const F pick = path_.sampler.next_1d(at->traced);
    const BsdfSampleOf<F> sample = sample_bsdf(s.shiny, s.wo, pick, u);
    const Vec3Of<F> wi = s.frame.to_world(sample.wi);
    const Mask can_share = at->traced & at->solid & !s.bsdf.layered &
                           (v.roughness >= interactive::kLeastSharedRoughness);
    ReflectionOf<F> r;
    ReflectionUseOf<F>& use = r.use;
    use.together = even_quads<F>(can_share, at->hit.instance, v.normal);
    use.borrows = use.together & !pixels_.leaders.of_quad;
    use.goes =
        at->traced & !use.borrows & (sample.pdf > 0.0f) & (max_component(sample.weight) > 0.0f);
    ReflectedRayOf<F>& reflected = r.reflected;
    reflected.ray = path_.ray;
    reflected.ray.o = leave_surface(v.p, v.geometric, wi, v.t);
    reflected.ray.d = wi;
    reflected.cone_width = path_.cone_width;
    reflected.cone_spread =
        path_.cone_spread +
        interactive::kLobeWidening * square_root(min(1.0f / (kPi * sample.pdf), F(1.0f)));
    reflected.pdf = sample.pdf;
    reflected.flames = !blurs_flames(v, s.shiny);
    reflected.from = v.p;
    reflected.normal = v.geometric;
    reflected.lists = at->lists;
    reflected.sampler = path_.sampler;
    use.weight = sample.weight;
    use.albedo = at->reflected;
    if (const Mask now = use.goes & at->pane; any(now)) {
      const Vec3Of<F> seen = trace_reflection(world_, reflected, now, &path_.result.rays,
                                              requests_ + kReflectionRequest * kLanes);
      at->lamps.specular += select<F>(now, sample.weight * seen, Vec3Of<F>{});
    }
    use.goes = use.goes & at->solid;
    keep_reflection(r, at->solid);
  }

  GLOAM_HD void keep_reflection(const ReflectionOf<F>& r, Mask solid) {
    if (passed_ == 0) {
      out_.reflection = r;
      return;
    }
    ReflectionUseOf<F>& all = out_.reflection.use;
    each_lane(solid, [&](int i) { copy_lane(r.reflected, i, &out_.reflection.reflected, i); });
    all.weight = select<F>(solid, r.use.weight, all.weight);
    all.albedo = select<F>(solid, r.use.albedo, all.albedo);
    all.goes = all.goes | r.use.goes;
    all.together = all.together | r.use.together;
    all.borrows = all.borrows | r.use.borrows;
  }

  GLOAM_HD void compose(const Vertex& at) {
    const SurfaceOf<F>& v = at.surface.v;
    const Vec3Of<F> albedo = diffuse_albedo(at.surface.bsdf);
    const Vec3Of<F> gloss = select<F>(at.traced, Vec3Of<F>{}, at.reflected);
    const Vec3Of<F> shade =
        albedo * (at.lamps.diffuse + at.cached) + gloss * at.cached + at.lamps.specular;
    out_.base += out_.through * select<F>(active_, v.emission * v.opacity, Vec3Of<F>{});
    out_.base += out_.through * select<F>(at.pane, shade * v.opacity, Vec3Of<F>{});
    const Mask solid = at.solid;
    out_.solid = out_.solid | solid;
    out_.p = select<F>(solid, v.p, out_.p);
    out_.normal = select<F>(solid, v.normal, out_.normal);
    out_.roughness = select(solid, v.roughness, out_.roughness);
    out_.hit.instance = select(solid, at.hit.instance, out_.hit.instance);
    out_.hit.primitive = select(solid, at.hit.primitive, out_.hit.primitive);
    out_.hit.u = select(solid, at.hit.u, out_.hit.u);
    out_.hit.v = select(solid, at.hit.v, out_.hit.v);
    out_.hit.t = select(solid, distance_, out_.hit.t);
    out_.albedo = select<F>(solid, albedo, out_.albedo);
    out_.gloss = select<F>(solid, gloss, out_.gloss);
    out_.direct = select<F>(solid, at.lamps.diffuse, out_.direct);
    out_.specular = select<F>(solid, at.lamps.specular, out_.specular);
  }

  GLOAM_HD void pass_panes(const Vertex& at) {
    const SurfaceOf<F>& v = at.surface.v;
    out_.through = select<F>(at.pane, out_.through * at.passing, out_.through);
    active_ = at.pane & (max_component(out_.through) > interactive::kOpaque);
    path_.ray.o =
        select<F>(active_, leave_surface(v.p, v.geometric, path_.ray.d, at.hit.t), path_.ray.o);
  }

  const InteractiveWorld<Tracer>& world_;
  const InteractivePixelsOf<F>& pixels_;
  CacheRequest* requests_;
  InteractiveSampleOf<F>& out_;
  Mask active_;
  paths::State<F> path_;
  F distance_ = 0.0f;    ///< from the camera [m]
  uint32_t passed_ = 0;  ///< panes
};

}  // namespace interactive

/// Sample of each pixel's camera ray, but for the light of InteractiveSampleOf::reflection.
/// `requests`: kRequests x Lanes<F>::kCount.
template <class F, class Tracer>
[[gnu::noinline]] GLOAM_HD InteractiveSampleOf<F> trace_camera_rays(
    const InteractiveWorld<Tracer>& world, const InteractivePixelsOf<F>& pixels,
    CacheRequest* requests) {
  InteractiveSampleOf<F> out;
  interactive::CameraRays<F, Tracer>(world, pixels, requests, &out).trace();
  return out;
}

}  // namespace gloam
