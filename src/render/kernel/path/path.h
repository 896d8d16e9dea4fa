#pragma once
// The path stage: one path, or one in each lane, from the camera to its end. Device-safe.

#include "render/kernel/camera/camera.h"
#include "render/kernel/light/light_directions.h"
#include "render/kernel/path/path_media.h"

namespace gloam {
namespace paths {

/// Fraction of a path's weight behind its first vertex below which it may end by Russian roulette.
/// The first vertex dims all of a pixel alike, and what the first reflections take off is not
/// little: to end paths by their mere weight made more noise than it saved time.
inline constexpr float kRouletteBelow = 0.35f;

/// Probability of sampling the guide instead of the BSDF: sharp lobes find their light by
/// themselves.
template <class F>
GLOAM_HD F guide_probability(const LightGuide& guide, const LayeredBsdfOf<F>& bsdf,
                             MaskOf<F> guided) {
  F diffuse = 1.0f - bsdf.base.p_layer;
  diffuse = select(bsdf.layered, diffuse * bsdf.p_base, diffuse);
  return select(guided, guide.probability * diffuse, F(0.0f));
}

/// BSDF at the vertices of paths, and the random number for the choice of its lobe.
template <class F>
struct ScatterOf {
  FrameOf<F> frame;
  LayeredBsdfOf<F> bsdf;
  Vec3Of<F> wo;  ///< in `frame`
  F lobe{};
  GuideRowsOf<F> rows;
  F guided{};  ///< probability of sampling the guide
};

/// Samples one light at the vertices of the `active` lanes.
template <class F>
GLOAM_HD NextEventOf<F> sample_light(const SceneView& scene, State<F>* path, const SurfaceOf<F>& v,
                                     MaskOf<F> active, ScatterOf<F>* at) {
  const Vec3Of<F> wo_W = -path->ray.d;
  at->bsdf = surface_bsdf(scene, v, wo_W, &at->frame, active);
  at->wo = at->frame.to_local(wo_W);
  const LayeredBsdfOf<F>& bsdf = at->bsdf;
  const MaskOf<F> both_sides = bsdf.layered & ((bsdf.p_glass > 0.0f) | (bsdf.p_beyond > 0.0f));

  at->rows = path->light_sampler.prepare(scene, v.p, v.geometric, active, both_sides);
  if (scene.has_glow()) path->light_sampler.add_glow(scene, active);
  if (scene.guides_directions()) at->guided = guide_probability(scene.guide, bsdf, at->rows.guided);
  at->lobe = path->sampler.next_1d(active);
  const Vec2Of<F> u = path->sampler.next_2d(active);
  const LightSampleOf<F> light = path->light_sampler.sample(scene, v.p, u, path->ray.time, active);
  const F side = dot(light.wi, v.geometric);
  NextEventOf<F> event;
  event.lit = active & (light.pdf > 0.0f) & ((side > 0.0f) | (both_sides & (side < 0.0f)));
  if (!any(event.lit)) return event;
  F pdf;
  const Vec3Of<F> wi = at->frame.to_local(light.wi);
  const Vec3Of<F> f = eval_bsdf(bsdf, at->wo, wi, &pdf);
  if (scene.guides_directions() && any(at->guided > 0.0f)) {
    pdf = lerp(pdf, directions::pdf(scene.guide, at->rows.row, light.wi), at->guided);
  }
  event.lit = event.lit & (max_component(f) > 0.0f) & (wi.z * side > 0.0f);
  event.casts_shadow = light.casts_shadow;
  const F weight = select(light.is_delta, F(1.0f), mis_weight(light.pdf, pdf));
  event.shadow = path->ray;
  aim_shadow_ray(v.p, v.geometric, v.t, light, &event.shadow);
  event.arriving = path->throughput * f * light.radiance * (weight / light.pdf);
  if (scene.has_layers()) {
    const Vec3Of<F> around =
        absorption_beyond(scene, v, event.lit & (side < 0.0f), path->absorption);
    event.arriving *= through_glass(around, light.distance);
  }
  return event;
}

/// Samples one direction at the vertices of the `active` lanes; returns the lanes whose path goes
/// on.
template <class F>
GLOAM_HD MaskOf<F> sample_direction(const SceneView& scene, const PathOptions& options,
                                    State<F>* path, const SurfaceOf<F>& v, const ScatterOf<F>& at,
                                    MaskOf<F> active) {
  MaskOf<F> next = can_continue(scene, options, *path, active);
  const Vec2Of<F> u = path->sampler.next_2d(next);
  if (!any(next)) return next;
  BsdfSampleOf<F> sample;
  Vec3Of<F> wi;
  if (scene.guides_directions() && any(at.guided > 0.0f)) {
    const MaskOf<F> by_guide = at.lobe < at.guided;
    const Vec3Of<F> arriving = directions::sample(scene.guide, at.rows.row, u);
    const F pick = clamp((at.lobe - at.guided) / (1.0f - at.guided), 0.0f, 0.99999994f);
    sample = sample_bsdf(at.bsdf, at.wo, pick, u, by_guide, at.frame.to_local(arriving));
    wi = select<F>(by_guide, arriving, at.frame.to_world(sample.wi));
    const F pdf = lerp(sample.pdf, directions::pdf(scene.guide, at.rows.row, wi), at.guided);
    sample.weight *= sample.pdf / pdf;
    sample.pdf = select(sample.pdf > 0.0f, pdf, F(0.0f));
  } else {
    sample = sample_bsdf(at.bsdf, at.wo, at.lobe, u);
    wi = at.frame.to_world(sample.wi);
  }
  const F side = dot(wi, v.geometric);
  next = next & (sample.pdf > 0.0f) & (sample.wi.z * side > 0.0f) &
         (max_component(sample.weight) > 0.0f);
  path->absorption = absorption_beyond(scene, v, next & (side < 0.0f), path->absorption);
  spawn_ray(next, v.p, leave_surface(v.p, v.geometric, wi, v.t), wi, sample.weight, sample.pdf,
            path);
  return next;
}

/// Samples one light and one direction at the vertices of the `active` lanes; returns the lanes
/// whose path goes on.
template <class F, class Tracer>
GLOAM_HD MaskOf<F> scatter(const SceneView& scene, const Tracer& tracer, const PathOptions& options,
                           State<F>* path, const SurfaceOf<F>& v, MaskOf<F> active) {
  ScatterOf<F> at;
  const NextEventOf<F> event = sample_light(scene, path, v, active, &at);
  if (any(event.lit)) {
    const Vec3Of<F> arriving = trace_shadow(scene, tracer, event.shadow, event.casts_shadow,
                                            event.lit, event.arriving, path);
    path->result.radiance += select<F>(event.lit, arriving, Vec3Of<F>{});
  }
  return sample_direction(scene, options, path, v, at, active);
}

/// End of a path's segment: the surface or medium vertex there, and whether the path scatters at it
/// or passes.
template <class F>
struct SegmentEndOf {
  SurfaceOf<F> v;
  MediumVertexOf<F> medium_vertex;  ///< in a medium, before the surface
  MaskOf<F> through = false;        ///< goes on behind the surface as if it were not there
  MaskOf<F> scatters = false;       ///< at the surface, or at the medium vertex
};

/// Medium vertex or surface that a segment leads to, before the surface is looked at.
template <class F>
struct ArrivalOf {
  MediumVertexOf<F> medium_vertex;
  MaskOf<F> found = false;  ///< a surface, which may scatter or give off light
};

/// Adds the light of lamps, media and the sky along the segments of the `active` lanes, and tells
/// where they lead. `found` and `hit`: what their rays have met.
template <class F>
GLOAM_HD ArrivalOf<F> arrive(const SceneView& scene, const PathOptions& options, State<F>* state,
                             MaskOf<F> active, MaskOf<F> found, const RayHitOf<F>& hit) {
  using Mask = MaskOf<F>;
  State<F>& path = *state;
  const uint32_t max_depth = static_cast<uint32_t>(options.max_depth);
  ArrivalOf<F> out;
  const Mask scattered = path.pdf_bsdf > 0.0f;
  if (scene.has_visible_lights && any(active & scattered)) {
    Vec2Of<F> u;
    if (scene.has_media()) u = path.sampler.next_2d(active & scattered);
    const Vec3Of<F> lamps = visible_lights(
        scene, path.ray, select(found, hit.t, F(1e30f)), path.from, path.light_sampler,
        path.pdf_bsdf, active & scattered, [&](int i, float t) {
          return transmittance(scene.media, lane(path.ray, i), t, {}, WalkRandom(lane(u, i)));
        });
    path.result.radiance += select<F>(active & scattered, path.throughput * lamps, Vec3Of<F>{});
  }
  MediumVertexOf<F>& medium_vertex = out.medium_vertex;
  if (scene.has_media()) {
    medium_vertex = cross_media(scene, select(found, hit.t, F(1e30f)), active, &path);
    active = active & !medium_vertex.scattered;
    found = found & !medium_vertex.scattered;
  }
  if (const Mask missed = active & !found; any(missed)) {
    Vec3Of<F> sky = sky_radiance_of(scene, path.ray.d, path.cone_spread, missed);
    sky = select<F>(path.depth > 0u, sky + in_all_lanes<F>(scene.sky_ambient), sky);
    const F weight = select(
        scattered, mis_weight(path.pdf_bsdf, path.light_sampler.sky_pdf(scene, path.ray.d, missed)),
        F(1.0f));
    path.result.radiance += select<F>(missed, path.throughput * sky * weight, Vec3Of<F>{});
  }
  const Mask last = found & (path.depth > 0u) & (path.depth + 1u >= max_depth);
  if (any(last)) found = found & !gives_nothing(scene, hit, last);
  out.found = found;
  return out;
}

/// Adds what the surfaces `v` give off, and decides what the paths do at the vertices of `at`.
template <class F>
GLOAM_HD void meet(const SceneView& scene, const PathOptions& options, const ArrivalOf<F>& at,
                   State<F>* state, SegmentEndOf<F>* out) {
  using Mask = MaskOf<F>;
  State<F>& path = *state;
  SurfaceOf<F>& v = out->v;
  const uint32_t max_depth = static_cast<uint32_t>(options.max_depth);
  const MediumVertexOf<F>& medium_vertex = out->medium_vertex = at.medium_vertex;
  const Mask found = at.found;
  const F way = select(medium_vertex.scattered, medium_vertex.t, v.t);
  if (scene.has_layers() && any(max_component(path.absorption) > 0.0f)) {
    path.throughput *= through_glass(path.absorption, way);
  }
  weigh_emission(scene, path, found, &v);
  Mask& through = out->through;
  if (scene.lets_light_through()) {
    const F opacity = opacity_of(v);
    const Mask thin = found & (opacity < 1.0f) & !(path.passed >= kMaxPassed);
    if (any(thin)) through = thin & (path.sampler.next_1d(thin) >= opacity);
    path.passed = select(through, path.passed + 1u, UintOf<F>(0u));
    // A clear sheet absorbs each colour by a fraction of its own.
    if (const Mask sheet = thin & (max_component(v.straight) > 0.0f); any(sheet)) {
      const Vec3Of<F> passing = path.throughput * passing_light(v) / (1.0f - opacity);
      path.throughput =
          select<F>(sheet, select<F>(through, passing, path.throughput * (v.opacity / opacity)),
                    path.throughput);
    }
  }
  Mask solid = found & !through;
  path.cone_width = select(found | medium_vertex.scattered,
                           path.cone_width + path.cone_spread * way, path.cone_width);
  const Mask first = solid & !path.seen_first;
  if (const Mask hidden = medium_vertex.scattered & !path.seen_first; any(hidden)) {
    each_lane(hidden, [&](int i) {
      set_lane(&path.result.albedo, i,
               Bands{}.of(scene.media.volumes[lane(medium_vertex.volume, i)].albedo));
    });
  }
  path.seen_first = path.seen_first | first | medium_vertex.scattered;
  path.result.albedo = select<F>(first, v.base_color, path.result.albedo);
  path.result.normal = select<F>(first, v.normal, path.result.normal);
  path.result.radiance += select<F>(solid, path.throughput * v.emission, Vec3Of<F>{});

  path.depth += select(solid | medium_vertex.scattered, UintOf<F>(1u), UintOf<F>(0u));
  Mask& scatters = out->scatters;
  scatters = (solid | medium_vertex.scattered) & !(path.depth >= max_depth);
  if (const Mask chance = scatters & (path.depth > static_cast<uint32_t>(options.roulette_depth));
      any(chance)) {
    const F survive = min(max_component(path.throughput) / (kRouletteBelow * path.scale), 1.0f);
    scatters = scatters & !(chance & (path.sampler.next_1d(chance) >= survive));
    path.throughput = select<F>(chance, path.throughput / survive, path.throughput);
  }
  if (any(through)) {  // past the surface, as if it were not there
    path.ray.o = select<F>(through, leave_surface(v.p, v.geometric, path.ray.d, v.t), path.ray.o);
  }
}

/// Adds the light of what the rays of the `active` lanes have met, and decides what the paths do
/// there.
template <class F>
GLOAM_HD SegmentEndOf<F> end_segment(const SceneView& scene, const PathOptions& options,
                                     State<F>* path, MaskOf<F> active, MaskOf<F> found,
                                     const RayHitOf<F>& hit) {
  SegmentEndOf<F> out;
  const ArrivalOf<F> at = arrive(scene, options, path, active, found, hit);
  if (!any(at.found | at.medium_vertex.scattered)) return out;
  out.v = make_surface(scene, path->ray, hit, RayConeOf<F>{path->cone_width, path->cone_spread},
                       at.found);
  meet(scene, options, at, path, &out);
  return out;
}

/// One segment of the paths of the `active` lanes and what becomes of them at its end; returns the
/// lanes whose path goes on.
template <class F, class Tracer>
GLOAM_HD MaskOf<F> advance(const SceneView& scene, const Tracer& tracer, const PathOptions& options,
                           bool coherent, State<F>* path, MaskOf<F> active) {
  RayHitOf<F> hit;
  path->result.rays += select(active, UintOf<F>(1u), UintOf<F>(0u));
  const MaskOf<F> found = tracer.closest(path->ray, active, coherent, &hit);
  const SegmentEndOf<F> at = end_segment(scene, options, path, active, found, hit);
  active = at.through;
  if (const MaskOf<F> on = at.scatters & !at.medium_vertex.scattered; any(on)) {
    active = active | scatter(scene, tracer, options, path, at.v, on);
  }
  if (const MaskOf<F> in = at.scatters & at.medium_vertex.scattered; any(in)) {
    active = active | scatter_in_media(scene, tracer, options, path, at.medium_vertex, in);
  }
  return active;
}

}  // namespace paths

/// An unbiased estimate of the radiance along each camera ray of the `active` lanes. At each vertex
/// one light and one direction of the BSDF or phase function are sampled and combined by the power
/// heuristic; transparent surfaces are passed by chance (path) or by attenuation (shadow rays). A
/// Tracer has
///   Mask closest(const RayOf<F>&, Mask active, bool coherent, RayHitOf<F>* hit) const,
///   Mask occluded(const RayOf<F>&, Mask active) const,
/// which return the lanes with a hit, of `active` alone.
template <class F, class Tracer>
GLOAM_HD PathResultOf<F> trace_path(const SceneView& scene, const Tracer& tracer,
                                    const RayOf<F>& ray, F cone_width, F cone_spread,
                                    const PathOptions& options, const SamplerOf<F>& sampler,
                                    MaskOf<F> active = true) {
  paths::State<F> path;
  LightProbabilitiesOf<F> probabilities;
  path.light_sampler.keep_in(&probabilities);
  path.start({ray, cone_width, cone_spread, sampler}, true);
  for (bool coherent = true; any(active); coherent = false) {
    active = paths::advance(scene, tracer, options, coherent, &path, active);
  }
  return path.result;
}

}  // namespace gloam
