#pragma once
// The path stage: one path, or one in each lane, from the camera to its end. Device-safe.

#include "render/kernel/camera.h"
#include "render/kernel/light_picker.h"
#include "render/kernel/sampler.h"

namespace gloam {

struct PathOptions {
  /// Segments of a path from the camera on, as Mitsuba counts: 1 = emitters seen directly, 2 =
  /// direct light, n = n - 1 reflections.
  int max_depth = 5;
  int roulette_depth = 100;  ///< segments before Russian roulette starts
};

/// What one camera sample saw.
template <class F>
struct PathResultOf {
  Vec3Of<F> radiance;   ///< [cd/m²]
  Vec3Of<F> albedo;     ///< of the first surface, 0 = sky
  Vec3Of<F> normal;     ///< of the first surface, 0 = sky
  UintOf<F> rays = 0u;  ///< traced
};
using PathResult = PathResultOf<float>;

/// Surfaces that a ray may pass because they are transparent, at most.
inline constexpr uint32_t kMaxPassed = 64;

namespace paths {

template <class F>
struct State {
  RayOf<F> ray;
  PathResultOf<F> result;
  MaskOf<F> seen_first = false;
  UintOf<F> depth = 0u, passed = 0u;
  F cone_width{}, cone_spread{};
  SamplerOf<F> sampler;
  Vec3Of<F> throughput;
  F pdf_bsdf = 0.0f;        ///< of the direction of the path's ray; 0 = from the camera
  Vec3Of<F> from;           ///< the last scattering vertex
  LightPickerOf<F> picker;  ///< of that vertex
  Vec3Of<F> absorption;     ///< of the glass that the path is in [1/m]
};

/// Share of light that glass lets through on a way of length t.
template <class F>
GLOAM_HD Vec3Of<F> through_glass(Vec3Of<F> absorption, F t) {
  Vec3Of<F> share = in_all_lanes<F>({1, 1, 1});
  each_lane(max_component(absorption) > 0.0f, [&](int i) {
    const Vec3f depth = lane(absorption, i) * lane(t, i);
    set_lane(&share, i, {expf(-depth.x), expf(-depth.y), expf(-depth.z)});
  });
  return share;
}

/// Absorption beyond the surfaces of the lanes in `crossing`.
template <class F>
GLOAM_HD Vec3Of<F> absorption_beyond(const SceneView& scene, const SurfaceOf<F>& v,
                                     MaskOf<F> crossing, Vec3Of<F> here) {
  if (scene.layers.size == 0) return here;
  each_lane(crossing, [&](int i) {
    const int row = scene.materials[scene.instances[lane(v.instance, i)].material].layers;
    if (row < 0) return;
    const MaterialLayers& m = scene.layers[static_cast<uint32_t>(row)];
    if (!m.thin) set_lane(&here, i, lane(v.outside, i) ? m.absorption : Vec3f{});
  });
  return here;
}

/// Weighs what the surfaces give off against the light sampling of the last vertex.
template <class F>
GLOAM_HD void weigh_emission(const SceneView& scene, const State<F>& path, MaskOf<F> found,
                             SurfaceOf<F>* s) {
  const MaskOf<F> sampled = found & (max_component(s->emission) > 0.0f) & (path.pdf_bsdf > 0.0f);
  each_lane(sampled, [&](int i) {
    const InstanceView& instance = scene.instances[lane(s->instance, i)];
    if (instance.light < 0) return;
    const float selected = path.picker.probability(scene, static_cast<uint32_t>(instance.light), i);
    const float pdf =
        selected * lights::instance_pdf(scene, instance, lane(path.from, i), lane(s->p, i),
                                        lane(s->geometric, i), lane(path.ray.time, i));
    set_lane(&s->emission, i, lane(s->emission, i) * mis_weight(lane(path.pdf_bsdf, i), pdf));
  });
}

/// Lanes whose surface can neither scatter any more nor give off light: most of the last ones.
template <class F>
GLOAM_HD MaskOf<F> gives_nothing(const SceneView& scene, const RayHitOf<F>& hit, MaskOf<F> last) {
  MaskOf<F> dark = last;
  each_lane(last, [&](int i) {
    const MaterialView& m = scene.materials[scene.instances[lane(hit.instance, i)].material];
    if (m.transparent || max_component(m.emission) > 0) set_lane(&dark, i, false);
  });
  return dark;
}

/// What is left of the light along the shadow rays of the `open` lanes.
template <class F, class Tracer>
GLOAM_HD Vec3Of<F> transmit(const SceneView& scene, const Tracer& tracer, RayOf<F> ray,
                            MaskOf<F> open, UintOf<F>* rays) {
  Vec3Of<F> light = in_all_lanes<F>({1, 1, 1});
  if (!scene.has_transparent) {
    *rays += select(open, UintOf<F>(1u), UintOf<F>(0u));
    return select<F>(tracer.occluded(ray, open), Vec3Of<F>{}, light);
  }
  for (uint32_t passed = 0; passed <= kMaxPassed && any(open); ++passed) {
    RayHitOf<F> hit;
    *rays += select(open, UintOf<F>(1u), UintOf<F>(0u));
    open = tracer.closest(ray, open, false, &hit);
    if (!any(open)) break;
    const SurfaceOf<F> s = make_surface(scene, ray, hit, {}, open);
    const Vec3Of<F> through = passed < kMaxPassed ? passing_light(s) : Vec3Of<F>{};
    light = select<F>(open, light * through, light);
    ray.o = select<F>(open, leave_surface(s.p, s.geometric, ray.d, hit.t), ray.o);
    ray.tmax = select(open, ray.tmax - hit.t, ray.tmax);
    open = open & (max_component(through) > 0.0f) & (ray.tmax > 0.0f);
  }
  return light;
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

  path->picker.prepare(scene, v.p, v.geometric, active, both_sides);
  const Vec2Of<F> choice = path->sampler.next_2d(active);  // of the light, of the lobe
  const Vec2Of<F> u_light = path->sampler.next_2d(active);
  const LightSampleOf<F> light =
      path->picker.sample(scene, v.p, choice.x, u_light, path->ray.time, path->cone_spread, active);
  F side = dot(light.wi, v.geometric);
  MaskOf<F> lit = active & (light.pdf > 0.0f) & ((side > 0.0f) | (both_sides & (side < 0.0f)));
  if (any(lit)) {
    F pdf;
    const Vec3Of<F> wi = frame.to_local(light.wi);
    const Vec3Of<F> f = eval_bsdf(bsdf, wo, wi, &pdf);
    lit = lit & (max_component(f) > 0.0f) & (wi.z * side > 0.0f);
    const F weight = select(light.is_delta, F(1.0f), mis_weight(light.pdf, pdf));
    Vec3Of<F> arriving = path->throughput * f * light.radiance * (weight / light.pdf);
    const MaskOf<F> shadowed = lit & light.casts_shadow;
    if (any(shadowed)) {
      RayOf<F> shadow = path->ray;
      aim_shadow_ray(v.p, v.geometric, v.t, light, &shadow);
      arriving = select<F>(shadowed,
                           arriving * transmit(scene, tracer, shadow, shadowed, &path->result.rays),
                           arriving);
    }
    if (scene.layers.size > 0) {
      const Vec3Of<F> around =
          paths::absorption_beyond(scene, v, lit & (side < 0.0f), path->absorption);
      arriving *= through_glass(around, light.distance);
    }
    path->result.radiance += select<F>(lit, arriving, Vec3Of<F>{});
  }

  // The last segment can only bring light from something that a ray can hit.
  MaskOf<F> next = active;
  if (!scene.has_emitters)
    next = next & !(path->depth + 1u >= static_cast<uint32_t>(options.max_depth));
  const Vec2Of<F> u = path->sampler.next_2d(next);
  if (!any(next)) return next;
  const BsdfSampleOf<F> sample = sample_bsdf(bsdf, wo, choice.y, u);
  const Vec3Of<F> wi = frame.to_world(sample.wi);
  side = dot(wi, v.geometric);
  next = next & (sample.pdf > 0.0f) & (sample.wi.z * side > 0.0f) &
         (max_component(sample.weight) > 0.0f);
  path->absorption = absorption_beyond(scene, v, next & (side < 0.0f), path->absorption);
  path->throughput = select<F>(next, path->throughput * sample.weight, path->throughput);
  path->pdf_bsdf = select(next, sample.pdf, path->pdf_bsdf);
  path->from = select<F>(next, v.p, path->from);
  // The cone widens with the lobe: texture detail that a broad lobe averages is not sought.
  const F widening = 0.2f * square_root(min(1.0f / (kPi * sample.pdf), 1.0f));
  path->cone_spread = select(next, path->cone_spread + widening, path->cone_spread);
  path->ray.o = select<F>(next, leave_surface(v.p, v.geometric, wi, v.t), path->ray.o);
  path->ray.d = select<F>(next, wi, path->ray.d);
  return next;
}

}  // namespace paths

/// An unbiased estimate of the radiance along each camera ray of the `active` lanes. At each vertex
/// one light and one direction of the BSDF are sampled and combined by the power heuristic;
/// transparent surfaces are passed by chance (path) or by attenuation (shadow rays). A Tracer has
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
      const Vec3Of<F> lamps =
          visible_lights(scene, path.ray, select(found, hit.t, F(1e30f)), path.from, path.picker,
                         path.pdf_bsdf, active & scattered);
      path.result.radiance += select<F>(active & scattered, path.throughput * lamps, Vec3Of<F>{});
    }
    if (const Mask missed = active & !found; any(missed)) {
      Vec3Of<F> sky = sky_radiance_of(scene, path.ray.d, path.cone_spread);
      sky = select<F>(path.depth > 0u, sky + in_all_lanes<F>(scene.sky_ambient), sky);
      const F weight =
          select(scattered, mis_weight(path.pdf_bsdf, path.picker.sky_pdf(path.ray.d)), F(1.0f));
      path.result.radiance += select<F>(missed, path.throughput * sky * weight, Vec3Of<F>{});
    }
    const Mask last = found & (path.depth > 0u) & (path.depth + 1u >= max_depth);
    if (any(last)) found = found & !paths::gives_nothing(scene, hit, last);
    if (!any(found)) break;
    if (scene.layers.size > 0 && any(max_component(path.absorption) > 0.0f)) {
      path.throughput *= paths::through_glass(path.absorption, hit.t);
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
    path.cone_width = select(found, path.cone_width + path.cone_spread * hit.t, path.cone_width);
    const Mask first = solid & !path.seen_first;
    path.seen_first = path.seen_first | first;
    path.result.albedo = select<F>(first, v.base_color, path.result.albedo);
    path.result.normal = select<F>(first, v.normal, path.result.normal);
    path.result.radiance += select<F>(solid, path.throughput * v.emission, Vec3Of<F>{});

    path.depth += one(solid);
    solid = solid & !(path.depth >= max_depth);
    if (const Mask chance = solid & (path.depth > static_cast<uint32_t>(options.roulette_depth));
        any(chance)) {
      const F survive = min(max_component(path.throughput), 0.95f);
      solid = solid & !(chance & (path.sampler.next_1d(chance) >= survive));
      path.throughput = select<F>(chance, path.throughput / survive, path.throughput);
    }
    if (any(through)) {  // past the surface, as if it were not there
      path.ray.o =
          select<F>(through, leave_surface(v.p, v.geometric, path.ray.d, hit.t), path.ray.o);
    }
    active = through;
    if (any(solid)) active = active | paths::scatter(scene, tracer, options, &path, v, solid);
  }
  return path.result;
}

}  // namespace gloam
