#pragma once
// State of a path, and its tests for occlusion and transmittance. Device-safe.

#include "render/kernel/light/light_sampler.h"
#include "render/kernel/math/sampler.h"
#include "render/kernel/media/medium.h"

namespace gloam {

struct PathOptions {
  /// Segments of a path from the camera on, as Mitsuba counts: 1 = emitters seen directly, 2 =
  /// direct light, n = n - 1 reflections.
  int max_depth = 5;
  int roulette_depth = 100;  ///< segments before Russian roulette starts
};

/// Result of one camera sample.
template <class F>
struct PathResultOf {
  Vec3Of<F> radiance;   ///< [cd/m²]
  Vec3Of<F> albedo;     ///< of the first surface, or the medium that scattered before it; 0 = sky
  Vec3Of<F> normal;     ///< of the first surface, 0 = sky or medium
  UintOf<F> rays = 0u;  ///< traced
};
using PathResult = PathResultOf<float>;

/// Surfaces that a ray may pass because they are transparent, at most.
inline constexpr uint32_t kMaxPassed = 64;

namespace paths {

/// A camera ray, how wide it is, and the numbers that are left to its path.
template <class F>
struct CameraSampleOf {
  RayOf<F> ray;
  F cone_width{}, cone_spread{};
  SamplerOf<F> sampler;
};

template <class F>
struct State {
  RayOf<F> ray;
  PathResultOf<F> result;
  MaskOf<F> seen_first = false;
  UintOf<F> depth = 0u, passed = 0u;
  F cone_width{}, cone_spread{};
  SamplerOf<F> sampler;
  Vec3Of<F> throughput;
  F scale = 1.0f;                   ///< the most of it behind the first vertex
  F pdf_bsdf = 0.0f;                ///< of the direction of the path's ray; 0 = from the camera
  Vec3Of<F> from;                   ///< the last scattering vertex
  LightSamplerOf<F> light_sampler;  ///< of that vertex
  Vec3Of<F> absorption;             ///< of the glass that the path is in [1/m]

  /// The given lanes begin a path; what the others are at stays.
  GLOAM_HD void start(const CameraSampleOf<F>& camera, MaskOf<F> lanes) {
    const MaskOf<F> others = !lanes;
    ray.o = select<F>(lanes, camera.ray.o, ray.o);
    ray.d = select<F>(lanes, camera.ray.d, ray.d);
    ray.tmax = select(lanes, camera.ray.tmax, ray.tmax);
    ray.time = select(lanes, camera.ray.time, ray.time);
    cone_width = select(lanes, camera.cone_width, cone_width);
    cone_spread = select(lanes, camera.cone_spread, cone_spread);
    sampler.take(lanes, camera.sampler);
    result.radiance = select<F>(lanes, Vec3Of<F>{}, result.radiance);
    result.albedo = select<F>(lanes, Vec3Of<F>{}, result.albedo);
    result.normal = select<F>(lanes, Vec3Of<F>{}, result.normal);
    result.rays = select(lanes, UintOf<F>(0u), result.rays);
    seen_first = seen_first & others;
    depth = select(lanes, UintOf<F>(0u), depth);
    passed = select(lanes, UintOf<F>(0u), passed);
    throughput = select<F>(lanes, in_all_lanes<F>({1, 1, 1}), throughput);
    scale = select(lanes, F(1.0f), scale);
    pdf_bsdf = select(lanes, F(0.0f), pdf_bsdf);
    absorption = select<F>(lanes, Vec3Of<F>{}, absorption);
  }
};

/// A shadow ray and the light that arrives along it where nothing is in between.
template <class F>
struct NextEventOf {
  RayOf<F> shadow;
  MaskOf<F> lit = false, casts_shadow = false;
  Vec3Of<F> arriving;
};

/// Transmittance of glass over a way of length t.
template <class F>
GLOAM_HD Vec3Of<F> through_glass(Vec3Of<F> absorption, F t) {
  Vec3Of<F> transmittance = in_all_lanes<F>({1, 1, 1});
  each_lane(max_component(absorption) > 0.0f, [&](int i) {
    const Vec3f depth = lane(absorption, i) * lane(t, i);
    set_lane(&transmittance, i, {expf(-depth.x), expf(-depth.y), expf(-depth.z)});
  });
  return transmittance;
}

/// Absorption beyond the surfaces of the lanes in `crossing`.
template <class F>
GLOAM_HD Vec3Of<F> absorption_beyond(const SceneView& scene, const SurfaceOf<F>& v,
                                     MaskOf<F> crossing, Vec3Of<F> here) {
  if (!scene.has_layers()) return here;
  each_lane(crossing, [&](int i) {
    const int row = scene.materials[scene.instances[lane(v.instance, i)].material].layers;
    if (row < 0) return;
    const MaterialLayers& m = scene.layers[static_cast<uint32_t>(row)];
    if (!m.thin) set_lane(&here, i, lane(v.outside, i) ? m.absorption : Vec3f{});
  });
  return here;
}

/// Density with which light sampling finds the points of emitters that path.ray has hit from
/// path.from, if it takes the light of a row with the probability chance(row, lane).
template <class F, class Chance>
GLOAM_HD F emitter_pdf(const SceneView& scene, const State<F>& path, const SurfaceOf<F>& s,
                       MaskOf<F> active, const Chance& chance) {
  F pdf = 0.0f;
  each_lane(active, [&](int i) {
    const InstanceView& instance = scene.instances[lane(s.instance, i)];
    if (instance.light < 0) return;
    set_lane(&pdf, i,
             chance(static_cast<uint32_t>(instance.light), i) *
                 lights::instance_pdf(scene, instance, lane(path.from, i), lane(s.p, i),
                                      lane(s.geometric, i), lane(path.ray.time, i)));
  });
  return pdf;
}

/// Weighs what the surfaces give off against the light sampling of the last vertex.
template <class F>
GLOAM_HD void weigh_emission(const SceneView& scene, const State<F>& path, MaskOf<F> found,
                             SurfaceOf<F>* s) {
  if (kPlainScenes) return;  // without emitters that are sampled
  const MaskOf<F> sampled = found & (max_component(s->emission) > 0.0f) & (path.pdf_bsdf > 0.0f);
  if (!any(sampled)) return;
  const F pdf = emitter_pdf(scene, path, *s, sampled, [&](uint32_t row, int i) {
    return path.light_sampler.probability(scene, row, i);
  });
  s->emission =
      select<F>(sampled & (pdf > 0.0f), s->emission * mis_weight(path.pdf_bsdf, pdf), s->emission);
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

/// Transmittance of surfaces along the shadow rays of the `open` lanes.
template <class F, class Tracer>
GLOAM_HD Vec3Of<F> transmit(const SceneView& scene, const Tracer& tracer, RayOf<F> ray,
                            MaskOf<F> open, UintOf<F>* rays) {
  Vec3Of<F> light = in_all_lanes<F>({1, 1, 1});
  if (!scene.lets_light_through()) {
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

/// Transmittance of media along the rays of the `active` lanes.
template <class F>
GLOAM_HD Vec3Of<F> through_media(const SceneView& scene, const RayOf<F>& ray, MaskOf<F> active,
                                 SamplerOf<F>* sampler) {
  Vec3Of<F> passed = in_all_lanes<F>({1, 1, 1});
  if (!scene.has_media()) return passed;
  const Vec2Of<F> u = sampler->next_2d(active);
  each_lane(active, [&](int i) {
    const Ray one = lane(ray, i);
    set_lane(&passed, i, transmittance(scene.media, one, one.tmax, {}, WalkRandom(lane(u, i))));
  });
  return passed;
}

/// Light of a light sample that gets through along its shadow ray, in the `lit` lanes. `arriving`:
/// the same where nothing is in between.
template <class F, class Tracer>
GLOAM_HD Vec3Of<F> trace_shadow(const SceneView& scene, const Tracer& tracer,
                                const RayOf<F>& shadow, MaskOf<F> casts_shadow, MaskOf<F> lit,
                                Vec3Of<F> arriving, State<F>* path) {
  if (const MaskOf<F> shadowed = lit & casts_shadow; any(shadowed)) {
    const Vec3Of<F> passed = transmit(scene, tracer, shadow, shadowed, &path->result.rays);
    arriving = select<F>(shadowed, arriving * passed, arriving);
  }
  const MaskOf<F> left = lit & (max_component(arriving) > 0.0f);
  return arriving * through_media(scene, shadow, left, &path->sampler);
}

/// Continues the paths of the `next` lanes from p, or `o` just off it, along wi, which was sampled
/// with the density `pdf`.
template <class F>
GLOAM_HD void spawn_ray(MaskOf<F> next, Vec3Of<F> p, Vec3Of<F> o, Vec3Of<F> wi, Vec3Of<F> weight,
                        F pdf, State<F>* path) {
  path->throughput = select<F>(next, path->throughput * weight, path->throughput);
  path->pdf_bsdf = select(next, pdf, path->pdf_bsdf);
  path->scale = select(next & (path->depth == 1u), max_component(path->throughput), path->scale);
  path->from = select<F>(next, p, path->from);
  // The cone widens with the lobe: texture detail that a broad lobe averages is not sought.
  const F widening = 0.2f * square_root(min(1.0f / (kPi * pdf), 1.0f));
  path->cone_spread = select(next, path->cone_spread + widening, path->cone_spread);
  path->ray.o = select<F>(next, o, path->ray.o);
  path->ray.d = select<F>(next, wi, path->ray.d);
}

/// Lanes that take one segment more, of which the last can only bring light from something that a
/// ray can hit.
template <class F>
GLOAM_HD MaskOf<F> can_continue(const SceneView& scene, const PathOptions& options,
                                const State<F>& path, MaskOf<F> active) {
  if (scene.has_emitters) return active;
  return active & !(path.depth + 1u >= static_cast<uint32_t>(options.max_depth));
}

}  // namespace paths
}  // namespace gloam
