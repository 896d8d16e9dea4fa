#pragma once
// The path stage: one path, or one in each lane, from the camera to its end. Device-safe.

#include "render/kernel/camera.h"
#include "render/kernel/light_directions.h"
#include "render/kernel/path_media.h"

namespace gloam {
namespace paths {

/// Share of directions that are drawn from the guide instead of the BSDF: what is sharp finds its
/// light by itself.
template <class F>
GLOAM_HD F guided_share(const LightGuide& guide, const LayeredBsdfOf<F>& bsdf, MaskOf<F> guided) {
  F diffuse = 1.0f - bsdf.base.p_layer;
  diffuse = select(bsdf.layered, diffuse * bsdf.p_base, diffuse);
  return select(guided, guide.share * diffuse, F(0.0f));
}

/// Samples one light and one direction at the vertices of the `active` lanes; returns the lanes
/// whose path goes on.
template <class F, class Tracer>
GLOAM_HD MaskOf<F> scatter(const SceneView& scene, const Tracer& tracer, const PathOptions& options,
                           State<F>* path, const SurfaceOf<F>& v, MaskOf<F> active) {
  const Vec3Of<F> wo_W = -path->ray.d;
  FrameOf<F> frame;
  const LayeredBsdfOf<F> bsdf = surface_bsdf(scene, v, wo_W, &frame, active);
  const Vec3Of<F> wo = frame.to_local(wo_W);
  const MaskOf<F> both_sides = bsdf.layered & ((bsdf.p_glass > 0.0f) | (bsdf.p_beyond > 0.0f));

  const GuideRowsOf<F> rows = path->picker.prepare(scene, v.p, v.geometric, active, both_sides);
  const F guided = guided_share(scene.guide, bsdf, rows.guided);
  const Vec2Of<F> choice = path->sampler.next_2d(active);  // of the light, of the lobe
  const Vec2Of<F> u_light = path->sampler.next_2d(active);
  const LightSampleOf<F> light =
      path->picker.sample(scene, v.p, choice.x, u_light, path->ray.time, active);
  F side = dot(light.wi, v.geometric);
  MaskOf<F> lit = active & (light.pdf > 0.0f) & ((side > 0.0f) | (both_sides & (side < 0.0f)));
  if (any(lit)) {
    F pdf;
    const Vec3Of<F> wi = frame.to_local(light.wi);
    const Vec3Of<F> f = eval_bsdf(bsdf, wo, wi, &pdf);
    if (any(guided > 0.0f))
      pdf = lerp(pdf, directions::pdf(scene.guide, rows.row, light.wi), guided);
    lit = lit & (max_component(f) > 0.0f) & (wi.z * side > 0.0f);
    const F weight = select(light.is_delta, F(1.0f), mis_weight(light.pdf, pdf));
    RayOf<F> shadow = path->ray;
    aim_shadow_ray(v.p, v.geometric, v.t, light, &shadow);
    Vec3Of<F> arriving =
        bring_light(scene, tracer, shadow, light.casts_shadow, lit,
                    path->throughput * f * light.radiance * (weight / light.pdf), path);
    if (scene.layers.size > 0) {
      const Vec3Of<F> around = absorption_beyond(scene, v, lit & (side < 0.0f), path->absorption);
      arriving *= through_glass(around, light.distance);
    }
    path->result.radiance += select<F>(lit, arriving, Vec3Of<F>{});
  }

  MaskOf<F> next = may_go_on(scene, options, *path, active);
  const Vec2Of<F> u = path->sampler.next_2d(next);
  if (!any(next)) return next;
  BsdfSampleOf<F> sample;
  Vec3Of<F> wi;
  if (any(guided > 0.0f)) {
    const MaskOf<F> by_guide = choice.y < guided;
    const Vec3Of<F> arriving = directions::sample(scene.guide, rows.row, u);
    const F pick = clamp((choice.y - guided) / (1.0f - guided), 0.0f, 0.99999994f);
    sample = sample_bsdf(bsdf, wo, pick, u, by_guide, frame.to_local(arriving));
    wi = select<F>(by_guide, arriving, frame.to_world(sample.wi));
    const F pdf = lerp(sample.pdf, directions::pdf(scene.guide, rows.row, wi), guided);
    sample.weight *= sample.pdf / pdf;
    sample.pdf = select(sample.pdf > 0.0f, pdf, F(0.0f));
  } else {
    sample = sample_bsdf(bsdf, wo, choice.y, u);
    wi = frame.to_world(sample.wi);
  }
  side = dot(wi, v.geometric);
  next = next & (sample.pdf > 0.0f) & (sample.wi.z * side > 0.0f) &
         (max_component(sample.weight) > 0.0f);
  path->absorption = absorption_beyond(scene, v, next & (side < 0.0f), path->absorption);
  go_on(next, v.p, leave_surface(v.p, v.geometric, wi, v.t), wi, sample.weight, sample.pdf, path);
  return next;
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
  using Mask = MaskOf<F>;
  const auto one = [](Mask m) { return select(m, UintOf<F>(1u), UintOf<F>(0u)); };
  paths::State<F> path;
  path.ray = ray;
  path.cone_width = cone_width;
  path.cone_spread = cone_spread;
  path.sampler = sampler;
  path.throughput = in_all_lanes<F>({1, 1, 1});
  const uint32_t max_depth = static_cast<uint32_t>(options.max_depth);
  for (bool coherent = true; any(active); coherent = false) {
    RayHitOf<F> hit;
    path.result.rays += one(active);
    Mask found = tracer.closest(path.ray, active, coherent, &hit);
    const Mask scattered = path.pdf_bsdf > 0.0f;
    if (scene.has_visible_lights && any(active & scattered)) {
      Vec2Of<F> u;
      if (!scene.media.volumes.empty()) u = path.sampler.next_2d(active & scattered);
      const Vec3Of<F> lamps = visible_lights(
          scene, path.ray, select(found, hit.t, F(1e30f)), path.from, path.picker, path.pdf_bsdf,
          active & scattered, [&](int i, float t) {
            return transmittance(scene.media, lane(path.ray, i), t, {}, WalkRandom(lane(u, i)));
          });
      path.result.radiance += select<F>(active & scattered, path.throughput * lamps, Vec3Of<F>{});
    }
    paths::MediumVertexOf<F> mote;
    if (!scene.media.volumes.empty()) {
      mote = paths::cross_media(scene, select(found, hit.t, F(1e30f)), active, &path);
      active = active & !mote.scattered;
      found = found & !mote.scattered;
    }
    if (const Mask missed = active & !found; any(missed)) {
      Vec3Of<F> sky = sky_radiance_of(scene, path.ray.d, path.cone_spread, missed);
      sky = select<F>(path.depth > 0u, sky + in_all_lanes<F>(scene.sky_ambient), sky);
      const F weight = select(
          scattered, mis_weight(path.pdf_bsdf, path.picker.sky_pdf(scene, path.ray.d, missed)),
          F(1.0f));
      path.result.radiance += select<F>(missed, path.throughput * sky * weight, Vec3Of<F>{});
    }
    const Mask last = found & (path.depth > 0u) & (path.depth + 1u >= max_depth);
    if (any(last)) found = found & !paths::gives_nothing(scene, hit, last);
    if (!any(found | mote.scattered)) break;
    const F way = select(mote.scattered, mote.t, hit.t);
    if (scene.layers.size > 0 && any(max_component(path.absorption) > 0.0f)) {
      path.throughput *= paths::through_glass(path.absorption, way);
    }

    SurfaceOf<F> v =
        make_surface(scene, path.ray, hit, RayConeOf<F>{path.cone_width, path.cone_spread}, found);
    paths::weigh_emission(scene, path, found, &v);
    Mask through = false;
    if (scene.has_transparent) {
      const F met = met_share(v);
      const Mask thin = found & (met < 1.0f) & !(path.passed >= kMaxPassed);
      if (any(thin)) through = thin & (path.sampler.next_1d(thin) >= met);
      path.passed = select(through, path.passed + 1u, UintOf<F>(0u));
      // A clear sheet takes its own share of each colour.
      if (const Mask sheet = thin & (max_component(v.straight) > 0.0f); any(sheet)) {
        const Vec3Of<F> passing = path.throughput * passing_light(v) / (1.0f - met);
        path.throughput =
            select<F>(sheet, select<F>(through, passing, path.throughput * (v.opacity / met)),
                      path.throughput);
      }
    }
    Mask solid = found & !through;
    path.cone_width =
        select(found | mote.scattered, path.cone_width + path.cone_spread * way, path.cone_width);
    const Mask first = solid & !path.seen_first;
    path.seen_first = path.seen_first | first | mote.scattered;
    path.result.albedo = select<F>(first, v.base_color, path.result.albedo);
    path.result.normal = select<F>(first, v.normal, path.result.normal);
    path.result.radiance += select<F>(solid, path.throughput * v.emission, Vec3Of<F>{});

    path.depth += one(solid | mote.scattered);
    Mask scatters = (solid | mote.scattered) & !(path.depth >= max_depth);
    if (const Mask chance = scatters & (path.depth > static_cast<uint32_t>(options.roulette_depth));
        any(chance)) {
      const F survive = min(max_component(path.throughput), 0.95f);
      scatters = scatters & !(chance & (path.sampler.next_1d(chance) >= survive));
      path.throughput = select<F>(chance, path.throughput / survive, path.throughput);
    }
    if (any(through)) {  // past the surface, as if it were not there
      path.ray.o =
          select<F>(through, leave_surface(v.p, v.geometric, path.ray.d, hit.t), path.ray.o);
    }
    active = through;
    if (const Mask on = scatters & !mote.scattered; any(on)) {
      active = active | paths::scatter(scene, tracer, options, &path, v, on);
    }
    if (const Mask in = scatters & mote.scattered; any(in)) {
      active = active | paths::scatter_in_media(scene, tracer, options, &path, mote, in);
    }
  }
  return path.result;
}

}  // namespace gloam
