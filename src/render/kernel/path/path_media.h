#pragma once
// The path stage in participating media. Device-safe.

#include "render/kernel/light/light_directions.h"
#include "render/kernel/path/path_state.h"

namespace gloam::paths {

/// Vertices at which media scatter rays.
template <class F>
struct MediumVertexOf {
  MaskOf<F> scattered = false;
  F t{};               ///< distance along the ray [m]
  UintOf<F> volume{};  ///< row of MediaView::volumes
};

/// Samples the media along the rays of the `active` lanes up to `tmax`: emission and scattering.
template <class F>
GLOAM_HD MediumVertexOf<F> cross_media(const SceneView& scene, F tmax, MaskOf<F> active,
                                       State<F>* path) {
  MediumVertexOf<F> v;
  const Vec2Of<F> first = path->sampler.next_2d(active), later = path->sampler.next_2d(active);
  each_lane(active, [&](int i) {
    const Vec3f throughput = lane(path->throughput, i);
    const auto emission_weight = [&](const VolumeView& volume, Vec3f p_W, Vec3f p_G) {
      const float pdf = lane(path->pdf_bsdf, i);
      if (!scene.has_glow() || volume.glow < 0 || !(pdf > 0)) return 1.0f;
      return mis_weight(pdf, path->light_sampler.glow_pdf(scene, volume.glow, i, p_W, p_G));
    };
    const MediumEvent event =
        sample_distance(scene.media, lane(path->ray, i), lane(tmax, i), {}, throughput,
                        lane(first, i), WalkRandom(lane(later, i)), emission_weight);
    set_lane(&path->result.radiance, i,
             lane(path->result.radiance, i) + throughput * event.emission);
    set_lane(&path->throughput, i, throughput * event.weight);
    if (event.volume < 0) return;
    set_lane(&v.scattered, i, true);
    set_lane(&v.t, i, event.t);
    set_lane(&v.volume, i, static_cast<uint32_t>(event.volume));
  });
  return v;
}

/// Phase functions of the vertices for light from wi, and their densities.
template <class F>
GLOAM_HD Vec3Of<F> eval_phases(const SceneView& scene, const State<F>& path,
                               const MediumVertexOf<F>& v, Vec3Of<F> wi, MaskOf<F> active, F* pdf) {
  Vec3Of<F> value;
  each_lane(active, [&](int i) {
    const float cosine = dot(lane(path.ray.d, i), lane(wi, i));
    float density;
    set_lane(&value, i,
             eval_phase(scene.media.volumes[lane(v.volume, i)], {}, lane(path.throughput, i),
                        cosine, &density));
    set_lane(pdf, i, density);
  });
  return value;
}

/// Fraction of LightGuide::probability at a path's first vertex, if that is in a medium. Later ones
/// follow the phase function alone: of a guide each of many scatterings may double a path's weight,
/// and a few paths then hold a picture's light.
inline constexpr float kGuidedInMedia = 0.3f;

/// How directions are sampled at vertices in media.
template <class F>
struct MediumScatterOf {
  F band{};  ///< random number for the choice of the guide, or of a band
  GuideRowsOf<F> rows;
  F guided{};  ///< probability of sampling the guide
};

/// Samples one light at the vertices of the `active` lanes.
template <class F>
GLOAM_HD NextEventOf<F> sample_light_in_media(const SceneView& scene, State<F>* path,
                                              const MediumVertexOf<F>& v, MaskOf<F> active,
                                              MediumScatterOf<F>* at) {
  const Vec3Of<F> p = path->ray.o + path->ray.d * v.t;
  at->rows = path->light_sampler.prepare(scene, p, Vec3Of<F>{}, active);
  if (scene.has_glow()) path->light_sampler.add_glow(scene, active);
  if (scene.guides_directions()) {
    at->guided = select(at->rows.guided & (path->depth == 1u),
                        F(kGuidedInMedia * scene.guide.probability), F(0.0f));
  }
  at->band = path->sampler.next_1d(active);
  const Vec2Of<F> u = path->sampler.next_2d(active);
  const LightSampleOf<F> light = path->light_sampler.sample(scene, p, u, path->ray.time, active);
  NextEventOf<F> event;
  event.lit = active & (light.pdf > 0.0f);
  if (!any(event.lit)) return event;
  F pdf = 1.0f;
  const Vec3Of<F> f = eval_phases(scene, *path, v, light.wi, event.lit, &pdf);
  if (scene.guides_directions() && any(at->guided > 0.0f)) {
    pdf = lerp(pdf, directions::pdf(scene.guide, at->rows.row, light.wi), at->guided);
  }
  const F weight = select(light.is_delta, F(1.0f), mis_weight(light.pdf, pdf));
  event.casts_shadow = light.casts_shadow;
  event.shadow = path->ray;
  aim_shadow_ray(p, Vec3Of<F>{}, F(0.0f), light, &event.shadow);
  event.arriving = path->throughput * f * light.radiance * (weight / light.pdf);
  return event;
}

/// Samples one direction at the vertices of the `active` lanes; returns the lanes whose path goes
/// on.
template <class F>
GLOAM_HD MaskOf<F> sample_phase_direction(const SceneView& scene, const PathOptions& options,
                                          State<F>* path, const MediumVertexOf<F>& v,
                                          const MediumScatterOf<F>& at, MaskOf<F> active) {
  const Vec3Of<F> p = path->ray.o + path->ray.d * v.t;
  const MaskOf<F> next = can_continue(scene, options, *path, active);
  const Vec2Of<F> u = path->sampler.next_2d(next);
  Vec3Of<F> wi, weight;
  F pdf = 1.0f, band = at.band;
  MaskOf<F> by_guide = false;
  const bool guides = scene.guides_directions() && any(at.guided > 0.0f);
  if (guides) {
    by_guide = next & (at.band < at.guided);
    wi = directions::sample(scene.guide, at.rows.row, u);
    band = clamp((at.band - at.guided) / (1.0f - at.guided), 0.0f, 0.99999994f);
  }
  each_lane(next, [&](int i) {
    const VolumeView& volume = scene.media.volumes[lane(v.volume, i)];
    const Vec3f throughput = lane(path->throughput, i), d = lane(path->ray.d, i);
    PhaseSample s;
    if (lane(by_guide, i)) {
      s.wi = lane(wi, i);
      const Vec3f phase = eval_phase(volume, {}, throughput, dot(d, s.wi), &s.pdf);
      s.weight = phase / s.pdf;
    } else {
      s = sample_phase(volume, {}, throughput, d, lane(band, i), lane(u, i));
    }
    set_lane(&wi, i, s.wi);
    set_lane(&weight, i, s.weight);
    set_lane(&pdf, i, s.pdf);
  });
  if (guides) {
    const F mixed = lerp(pdf, directions::pdf(scene.guide, at.rows.row, wi), at.guided);
    weight *= pdf / mixed;
    pdf = mixed;
  }
  spawn_ray(next, p, p, wi, weight, pdf, path);
  return next;
}

/// Samples one light and one direction at the vertices of the `active` lanes; returns the lanes
/// whose path goes on.
template <class F, class Tracer>
GLOAM_HD MaskOf<F> scatter_in_media(const SceneView& scene, const Tracer& tracer,
                                    const PathOptions& options, State<F>* path,
                                    const MediumVertexOf<F>& v, MaskOf<F> active) {
  MediumScatterOf<F> at;
  const NextEventOf<F> event = sample_light_in_media(scene, path, v, active, &at);
  if (any(event.lit)) {
    const Vec3Of<F> arriving = trace_shadow(scene, tracer, event.shadow, event.casts_shadow,
                                            event.lit, event.arriving, path);
    path->result.radiance += select<F>(event.lit, arriving, Vec3Of<F>{});
  }
  return sample_phase_direction(scene, options, path, v, at, active);
}

}  // namespace gloam::paths
