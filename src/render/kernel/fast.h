#pragma once
// The fast stage: first surfaces with direct light of every lamp, one specular bounce, and indirect
// light from the irradiance cache. What is noisy comes out apart, for the filter. Device-safe.

#include "render/kernel/glow_line.h"
#include "render/kernel/irradiance_cache.h"
#include "render/kernel/medium_march.h"
#include "render/kernel/path.h"
#include "render/kernel/quads.h"

namespace gloam {

/// Scenes with more lights than this draw so many of them at each surface.
inline constexpr uint32_t kMaxFastLights = kMaxWeighedLights, kDrawnLights = 4;
/// Surfaces rougher than this reflect the light of the cache instead of what a ray finds: that is
/// of all directions alike.
inline constexpr float kMaxTracedRoughness = 0.6f;
/// Of two by two pixels on a surface as rough as this, one sends out a ray for all: what they
/// reflect is blurred over more than that.
inline constexpr float kLeastSharedRoughness = 0.2f;

/// A cell that a surface needs.
struct CacheRequest {
  uint64_t key = 0;  ///< 0 = none
  Vec3f p, n;        ///< where rays for it may start
  float g = 0;       ///< of their lobe about n, in the air
};

/// Lanes that send out rays for others of their quad too, where that will do.
template <class F>
struct FastTurnsOf {
  MaskOf<F> of_two = true;   ///< one of each pair side by side
  MaskOf<F> of_four = true;  ///< one of each quad
};

/// What becomes of the light that reflections' rays bring.
template <class F>
struct ReflectionUseOf {
  MaskOf<F> goes = false;      ///< lanes that have a ray of their own
  MaskOf<F> together = false;  ///< in quads that share what they have,
  MaskOf<F> borrows = false;   ///< and have none
  Vec3Of<F> weight;            ///< share of the ray's light that goes on to the camera
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

/// What one camera ray saw: base + air + through (albedo (direct + cached) + cached gloss +
/// specular + what its reflection shows).
template <class F>
struct FastSampleOf {
  Vec3Of<F> base;     ///< [cd/m²], with its edges
  Vec3Of<F> air;      ///< light that media scatter [cd/m²]: noise of few samples
  Vec3Of<F> through;  ///< share of the first solid surface's light that gets to the camera
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

namespace fasts {

/// The BSDF without its diffuse parts, sampled by itself.
template <class F>
GLOAM_HD LayeredBsdfOf<F> specular_part(LayeredBsdfOf<F> b) {
  b.base.diffuse = {};
  b.base.p_layer = select(b.base.p_layer > 0.0f, F(1.0f), F(0.0f));
  b.beyond = {};
  return b;
}
template <class F>
GLOAM_HD Vec3Of<F> diffuse_albedo(const LayeredBsdfOf<F>& b) {
  return select<F>(b.layered, b.base.diffuse * b.under, b.base.diffuse);
}

/// Surfaces so rough that samples of what glows make less noise of its reflection than rays do.
template <class F>
GLOAM_HD MaskOf<F> blurs_flames(const SurfaceOf<F>& v, const LayeredBsdfOf<F>& b) {
  const MaskOf<F> sharp =
      (b.p_glass > 0.0f) | ((b.p_coat > 0.0f) & (v.coat_roughness < kLeastSharedRoughness));
  return (v.roughness >= kLeastSharedRoughness) & !(b.layered & sharp);
}

/// Where the cache is asked: at surfaces, or in the air that a ray crosses.
template <class F>
struct CachePlaceOf {
  Vec3Of<F> p, n;
  UintOf<F> side;
  Vec3Of<F> start;  ///< of rays
  F g = 0.0f;       ///< mean cosine of what media there scatter
};
template <class F>
GLOAM_HD CachePlaceOf<F> place_of(const SurfaceOf<F>& v) {
  return {v.p, v.normal, select(v.outside, UintOf<F>(kOutsideCell), UintOf<F>(kInsideCell)),
          leave_surface(v.p, v.geometric, v.geometric, v.t)};
}

/// The cells of places; asks for them.
template <class F>
GLOAM_HD CacheCellOf<F> ask_cells(const IrradianceCacheView& cache, const CachePlaceOf<F>& at,
                                  MaskOf<F> active, Vec3Of<F> jitter, uint32_t coarser,
                                  CacheRequest* requests) {
  const CacheCellOf<F> cells = cache_cell<F>(cache, at.p, at.n, at.side, jitter, coarser);
  each_lane(active, [&](int i) {
    requests[i] = {cache_key(cells, i), lane(at.start, i), lane(at.n, i), lane(at.g, i)};
  });
  return cells;
}

/// What the cache holds for them. Until a cell is there, the one about the point itself or a larger
/// one stands for it, or `otherwise`.
template <class F>
GLOAM_HD Vec3Of<F> cached_light(const IrradianceCacheView& cache, const CachePlaceOf<F>& at,
                                const CacheCellOf<F>& cells, MaskOf<F> active, uint32_t coarser,
                                Vec3f otherwise) {
  Vec3Of<F> light;
  int cell[Lanes<F>::kCount];  // all before the first is read: the memory is waited for once
  each_lane(active, [&](int i) { cell[i] = find_cell(cache, cache_key(cells, i)); });
  each_lane(active, [&](int i) {
    for (uint32_t more = 0; cell[i] < 0 && more < 3; ++more) {
      cell[i] = find_cell(cache, cache_key(cache, lane(at.p, i), lane(at.n, i), lane(at.side, i),
                                           {0.5f, 0.5f, 0.0f}, coarser + more));
    }
    const bool known = cell[i] >= 0;
    set_lane(&light, i, known ? cache.light[static_cast<uint32_t>(cell[i])].all : otherwise);
  });
  return light;
}

/// For lamps, and for what glows with the probability `glow` where lights are too many to be
/// weighed against it; 0: not at all. The sky is the cache's.
template <class F>
GLOAM_HD void prepare_picker(const SceneView& scene, Vec3Of<F> p, Vec3Of<F> n, MaskOf<F> active,
                             float glow, LightPickerOf<F>* picker) {
  picker->prepare(scene, p, n, active);
  picker->leave_out_sky(scene);
  if (glow > 0 && scene.has_glow()) picker->add_glow(scene, active, glow);
}
/// Where one sample is taken, and of the samples at a surface.
inline constexpr float kOneGlow = 0.5f, kGlowAmongLamps = 1.0f / kDrawnLights;

/// A sample of a lamp, or of what glows.
template <class F>
struct LampSampleOf {
  LightSampleOf<F> light;
  F clear = 1e30f;  ///< what is farther away than this does not dim it [m]
  MaskOf<F> glows = false;
};

/// What glows, from p on a surface with the normal n, or in the air (n = 0), in the `active` lanes.
template <class F>
GLOAM_HD void sample_glow(const SceneView& scene, Vec3Of<F> p, Vec3Of<F> n, Vec2Of<F> u,
                          MaskOf<F> active, LampSampleOf<F>* out) {
  each_lane(active, [&](int i) {
    const glow::LineSample line =
        glow::sample_line(scene.media, lane(p, i), lane(n, i), lane(u, i));
    set_lane(&out->light, i, line.light);
    set_lane(&out->clear, i, line.clear);
  });
  out->glows = out->glows | active;
}

/// One of all, as `picker` takes them.
template <class F>
GLOAM_HD LampSampleOf<F> sample_lamp(const SceneView& scene, const LightPickerOf<F>& picker,
                                     Vec3Of<F> p, Vec3Of<F> n, Vec2Of<F> u, F time,
                                     MaskOf<F> active) {
  LampSampleOf<F> out;
  if (!scene.has_glow()) {
    out.light = picker.sample(scene, p, u, time, active);
    return out;
  }
  const F share = picker.glow_share();
  const MaskOf<F> glows = active & (u.x < share);
  out.light = picker.sample(scene, p, u, time, active & !glows);
  sample_glow(scene, p, n, Vec2Of<F>{rest_of(u.x, F(0.0f), share), u.y}, glows, &out);
  out.light.pdf = select(glows, out.light.pdf * share, out.light.pdf);
  return out;
}

/// Light of lamps at vertices, before media on its way.
template <class F>
struct ArrivingOf {
  Vec3Of<F> diffuse, specular;  ///< over the diffuse albedo, and the rest [cd/m²]
  RayOf<F> way;                 ///< of one sample, by what it brings
  F total = 0.0f;               ///< that all bring
};

/// Adds one lamp sample. `traced`: lanes whose specular ray may find the lamp too, if it has an
/// extent; of what `glows`, either that ray or this sample shows the reflection.
template <class F, class Tracer>
GLOAM_HD void add_light(const SceneView& scene, const Tracer& tracer, paths::State<F>* path,
                        const SurfaceOf<F>& v, const LayeredBsdfOf<F>& shiny,
                        const FrameOf<F>& frame, Vec3Of<F> wo, MaskOf<F> traced, MaskOf<F> active,
                        const LampSampleOf<F>& lamp, ArrivingOf<F>* sum) {
  const LightSampleOf<F>& light = lamp.light;
  MaskOf<F> lit = active & (light.pdf > 0.0f) & (dot(light.wi, v.geometric) > 0.0f);
  if (!any(lit)) return;
  const Vec3Of<F> wi = frame.to_local(light.wi);
  lit = lit & (wi.z > 0.0f);
  F pdf;
  const Vec3Of<F> f = eval_bsdf(shiny, wo, wi, &pdf);
  const F seen = select(blurs_flames(v, shiny), F(1.0f), F(0.0f));
  const F weight = select(traced & !light.is_delta,
                          select(lamp.glows, seen, mis_weight(light.pdf, pdf)), F(1.0f));
  RayOf<F> shadow = path->ray;
  aim_shadow_ray(v.p, v.geometric, v.t, light, &shadow);
  Vec3Of<F> arriving = light.radiance * (1.0f / light.pdf);
  if (const MaskOf<F> shadowed = lit & light.casts_shadow; any(shadowed)) {
    const Vec3Of<F> share = paths::transmit(scene, tracer, shadow, shadowed, &path->result.rays);
    arriving = select<F>(shadowed, arriving * share, arriving);
  }
  sum->diffuse += select<F>(lit, arriving * (wi.z * kInvPi), Vec3Of<F>{});
  sum->specular += select<F>(lit, arriving * f * weight, Vec3Of<F>{});
  if (!scene.has_media()) return;
  const F brings = select(lit, luminance(arriving) * wi.z, F(0.0f));
  sum->total += brings;
  const MaskOf<F> taken = path->sampler.next_1d(lit) * sum->total < brings;
  sum->way.o = select<F>(taken, shadow.o, sum->way.o);
  sum->way.d = select<F>(taken, shadow.d, sum->way.d);
  sum->way.tmax = select(taken, min(shadow.tmax, lamp.clear), sum->way.tmax);
}

/// Direct light at the vertices of the `active` lanes: of every light and of what glows where there
/// are few lights, or of `drawn` of them all. Media take from all what they take from one, in the
/// `borrows` lanes from one of the lane beside.
template <class F, class Tracer>
GLOAM_HD void direct_light(const SceneView& scene, const Tracer& tracer, paths::State<F>* path,
                           const SurfaceOf<F>& v, const LayeredBsdfOf<F>& shiny,
                           const FrameOf<F>& frame, Vec3Of<F> wo, MaskOf<F> traced,
                           MaskOf<F> active, MaskOf<F> borrows, bool every, uint32_t drawn,
                           Vec3Of<F>* diffuse, Vec3Of<F>* specular) {
  ArrivingOf<F> sum;
  const auto add = [&](const LampSampleOf<F>& lamp) {
    add_light(scene, tracer, path, v, shiny, frame, wo, traced, active, lamp, &sum);
  };
  if (scene.has_glow() && (every || scene.lights.size == 0)) {
    LampSampleOf<F> lamp;
    sample_glow(scene, v.p, v.geometric, path->sampler.next_2d(active), active, &lamp);
    add(lamp);
  }
  if (scene.lights.size > 0) {
    const float glow = every ? 0.0f : (drawn > 1 ? kGlowAmongLamps : kOneGlow);
    prepare_picker(scene, v.p, v.geometric, active, glow, &path->picker);
  }
  if (every || scene.lights.size == 0) drawn = scene.lights.size;
  for (uint32_t k = 0; k < drawn; ++k) {
    Vec2Of<F> u = path->sampler.next_2d(active);
    LampSampleOf<F> lamp;
    if (every) {
      const MaskOf<F> near = active & (path->picker.shares(k) > 0.0f);
      if (!any(near)) continue;
      lamp.light = sample_one_light(scene, k, v.p, u, path->ray.time, near);
      lamp.light.pdf = select(near, lamp.light.pdf, F(0.0f));
    } else {
      u.x = (u.x + static_cast<float>(k)) * (1.0f / static_cast<float>(drawn));
      lamp = sample_lamp(scene, path->picker, v.p, v.geometric, u, path->ray.time, active);
      lamp.light.pdf *= static_cast<float>(drawn);
    }
    add(lamp);
  }
  const MaskOf<F> lit = active & (sum.total > 0.0f);
  borrows = borrows & (flip<1>(sum.total) > 0.0f);
  Vec3Of<F> share = paths::through_media(scene, sum.way, lit & !borrows, &path->sampler);
  share = select<F>(borrows, flip<1>(share), share);
  *diffuse = sum.diffuse * share;
  *specular = sum.specular * share;
}

/// Probability with which direct_light() takes the light of a row.
template <class F>
GLOAM_HD float chance_of(const SceneView& scene, const paths::State<F>& path, uint32_t row,
                         bool every, uint32_t drawn, int i) {
  return every ? 1.0f : static_cast<float>(drawn) * path.picker.probability(scene, row, i);
}

/// A sample of lamps for a step of a ray through media.
struct AirLamp {
  LampSampleOf<float> lamp;
  Vec3f p_W;    ///< in the step
  Vec3f light;  ///< that it brings to the ray's origin if nothing is in between [cd/m²]
};

/// At p_W on the ray. `share`: MarchStep::share.
GLOAM_HD AirLamp sample_air(const SceneView& scene, const Ray& ray, const MediumPoint& medium,
                            Vec3f share, Vec3f p_W, WalkRandom* random) {
  AirLamp out{{}, p_W, {}};
  LightPicker picker;
  prepare_picker<float>(scene, p_W, Vec3f{}, true, kOneGlow, &picker);
  const Vec2f u{random->next(), random->next()};
  out.lamp = sample_lamp<float>(scene, picker, p_W, Vec3f{}, u, ray.time, true);
  const LightSample& light = out.lamp.light;
  if (!(light.pdf > 0)) return out;
  const float cosine = dot(ray.d, light.wi);
  const auto phase = [&](float scattering, float g_scattering) {
    const float g = scattering > 0 ? g_scattering / scattering : 0.0f;
    return scattering * henyey_greenstein(g, cosine);
  };
  const Vec3f s = medium.scattering, g = medium.g_scattering;
  out.light =
      Vec3f{phase(s.x, g.x), phase(s.y, g.y), phase(s.z, g.z)} * share * light.radiance / light.pdf;
  return out;
}

/// Share of its light that what lies between lets through.
template <class Tracer>
GLOAM_HD Vec3f arriving_share(const SceneView& scene, const Tracer& tracer, const Ray& ray,
                              const AirLamp& air, WalkRandom* random, uint32_t* rays) {
  Ray shadow = ray;
  aim_shadow_ray(air.p_W, Vec3f{}, 0.0f, air.lamp.light, &shadow);
  Vec3f share{1, 1, 1};
  if (air.lamp.light.casts_shadow) share = paths::transmit(scene, tracer, shadow, true, rays);
  if (!(max_component(share) > 0)) return {};
  return share * transmittance(scene.media, shadow, min(shadow.tmax, air.lamp.clear), {}, *random);
}

/// Light from all around that media of the mean cosine g at p_W scatter against a ray along d, by
/// what the cache has for the air there, or `otherwise`.
GLOAM_HD Vec3f air_light(const IrradianceCacheView& cache, Vec3f p_W, Vec3f d, float g,
                         uint32_t coarser, Vec3f otherwise, WalkRandom* random,
                         CacheRequest* request) {
  // Larger cells are asked for, too, to stand for those that are not there yet.
  constexpr float kLarger = 0.125f;
  constexpr uint32_t kLevels = 2;
  const CachePlaceOf<float> at{p_W, d, kAirCell, p_W, g};
  const Vec3f jitter{random->next(), random->next(), random->next()};
  const CacheCellOf<float> cell = ask_cells<float>(cache, at, true, jitter, coarser, request);
  if (random->next() < kLarger) {
    ask_cells<float>(cache, at, true, {0.5f, 0.5f, 0.0f}, coarser + kLevels, request);
  }
  return cached_light<float>(cache, at, cell, true, coarser, otherwise);
}

/// Light of what glows where samples of lamps leave it out: right before the ray [cd/m²].
GLOAM_HD Vec3f near_glow(const MediaView& media, const Ray& ray) {
  constexpr int kSteps = 4;
  return march(media, ray, min(ray.tmax, glow::kNearGlow), 0.0f, kSteps, {}, true,
               [](const MarchStep&) { return Vec3f{}; })
      .radiance;
}

/// Of that, what a medium of the mean cosine g at p_W scatters against a ray along d, by one
/// sample.
GLOAM_HD Vec3f near_glow_in_air(const MediaView& media, Vec3f p_W, Vec3f d, float g,
                                WalkRandom* random) {
  const float z = sample_henyey_greenstein(g, random->next());
  const float r = safe_sqrt(1 - z * z);
  float s, c;
  sincos_turn(random->next(), &s, &c);
  Ray ray;
  ray.o = p_W;
  ray.d = Frame::from_z(d).to_world({r * c, r * s, z});
  return near_glow(media, ray);
}

/// Takes of many as many as their chances add up to, evenly spread.
struct Turn {
  float owed;  ///< at first by chance, in [0, 1)
  GLOAM_HD bool comes(float chance) {
    owed += chance;
    if (owed < 1) return false;
    owed -= 1;
    return true;
  }
};

/// What media along path->ray up to `tmax` do to light: scatter that of lamps once and that of all
/// around, give off, and let through.
template <class F>
struct MediaLightOf {
  Vec3Of<F> radiance;   ///< that they give off [cd/m²]
  Vec3Of<F> around;     ///< scattered from all around [cd/m²]
  Vec3Of<F> lamps;      ///< scattered from lamps: one sample of one place [cd/m²]
  Vec3Of<F> scattered;  ///< share of what arrives from all around
  Vec3Of<F> through;
};
/// `samples`: lanes that take a sample of lamps. `glows`: what glows on the way counts. `requests`:
/// one per lane, for one of the places that scatter light.
template <class F, class Tracer>
GLOAM_HD MediaLightOf<F> cross_media(const SceneView& scene, const Tracer& tracer,
                                     const IrradianceCacheView& cache, F tmax, MaskOf<F> active,
                                     MaskOf<F> samples, int steps, uint32_t coarser,
                                     MaskOf<F> glows, paths::State<F>* path,
                                     CacheRequest* requests) {
  MediaLightOf<F> out{{}, {}, {}, {}, in_all_lanes<F>({1, 1, 1})};
  if (scene.media.volumes.empty()) return out;
  const Vec2Of<F> u = path->sampler.next_2d(active);
  each_lane(active, [&](int i) {
    WalkRandom random(lane(u, i));
    const Ray ray = lane(path->ray, i);
    // Steps ask by turns, the more seldom the less they scatter, and count for as many more.
    constexpr float kOfAir = 0.1f, kOfLamps = 0.4f;
    Turn of_air{random.next()}, of_lamps{random.next()};
    float weighed = 0;       // what has been asked for
    float in_all = 0;        // what lamps may bring
    Vec3f air = cache.mean;  // of the last step that the cache knew
    Vec3f around;
    AirLamp lit;  // of one step, which stands for all
    float brings = 0;
    const MarchResult m =
        march(scene.media, ray, lane(tmax, i), 0.0f, steps, {}, lane(glows, i),
              [&](const MarchStep& step) {
                const MediumPoint& point = step.medium;
                const Vec3f p_W = ray.o + ray.d * place_in(step, random.next());
                const Vec3f scattered = point.scattering * step.share;
                const float scatters = max_component(scattered);
                if (const float chance = min(scatters / kOfAir, 1.0f); of_air.comes(chance)) {
                  CacheRequest request;
                  const float g = luminance(point.g_scattering) / luminance(point.scattering);
                  air = air_light(cache, p_W, ray.d, g, coarser, air, &random, &request);
                  Vec3f from_all = air;
                  if (step.is_hot)
                    from_all += near_glow_in_air(scene.media, p_W, ray.d, g, &random);
                  around += scattered * from_all * (1 / chance);
                  weighed += scatters / chance;
                  if (random.next() * weighed < scatters / chance) requests[i] = request;
                }
                if (const float chance = min(scatters / kOfLamps, 1.0f);
                    lane(samples, i) && of_lamps.comes(chance)) {
                  const AirLamp one = sample_air(scene, ray, point, step.share, p_W, &random);
                  const float light = luminance(one.light);
                  in_all += light / chance;
                  if (random.next() * in_all < light / chance) {
                    lit = one;
                    brings = light;
                  }
                }
                return Vec3f{};
              });
    if (lane(samples, i) && in_all > 0) {
      uint32_t rays = 0;
      const Vec3f share = arriving_share(scene, tracer, ray, lit, &random, &rays);
      set_lane(&out.lamps, i, lit.light * share * (in_all / brings));
      set_lane(&path->result.rays, i, lane(path->result.rays, i) + rays);
    }
    set_lane(&out.radiance, i, m.radiance);
    set_lane(&out.around, i, around);
    set_lane(&out.scattered, i, m.scattered);
    set_lane(&out.through, i, m.transmittance);
  });
  return out;
}

/// Light of lamps' spheres and of suns that path->ray meets before `tmax`, weighed against
/// direct_light() at path->from.
template <class F>
GLOAM_HD Vec3Of<F> lamps_met(const SceneView& scene, const paths::State<F>& path, F tmax,
                             MaskOf<F> active) {
  const auto clear = [](int, float) { return Vec3f{1, 1, 1}; };
  Vec3Of<F> sum;
  if (scene.lights.size <= kMaxFastLights) {
    for (uint32_t i = 0; i < scene.lights.size; ++i) {
      sum += visible_light(
          scene, i, path.ray, tmax, path.from, path.pdf_bsdf, active, [] { return F(1.0f); },
          clear);
    }
    return sum;
  }
  each_lane(active, [&](int at) {
    const Ray ray = lane(path.ray, at);
    const float most = lane(tmax, at);
    Vec3f light;
    light_tree::each_shown(scene.light_tree, ray, most, [&](uint32_t i) {
      light += visible_light<float>(
          scene, i, ray, most, lane(path.from, at), lane(path.pdf_bsdf, at), true,
          [&] { return chance_of(scene, path, i, false, kDrawnLights, at); }, clear);
    });
    set_lane(&sum, at, light);
  });
  return sum;
}

/// What a ray brings.
template <class F>
struct GatheredOf {
  Vec3Of<F> light;  ///< [cd/m²]
  F way = 1e30f;    ///< to the first surface [m]
  UintOf<F> first;  ///< instance of that, if there is one
};

/// Light along path->ray in the `active` lanes, from its first surface that is no glass or mirror.
/// What lamps themselves send is weighed against direct_light() by path->pdf_bsdf if `count_lamps`;
/// if not, it is none of the path's business. `flames`: lanes in which what glows counts, `near`:
/// or does within glow::kNearGlow.
template <class F, class Tracer>
GLOAM_HD GatheredOf<F> gather(const SceneView& scene, const Tracer& tracer,
                              const IrradianceCacheView& cache, bool count_lamps, MaskOf<F> flames,
                              MaskOf<F> near, MaskOf<F> active, paths::State<F>* path,
                              CacheRequest* requests) {
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
      const MediaLightOf<F> media = cross_media(scene, tracer, cache, tmax, active, active, kSteps,
                                                count_lamps ? 0 : 2, flames, path, air);
      F limit = 1.0f;
      if (count_lamps) {  // no filter passes over what stands out of reflections
        constexpr float kBrightest = 4;
        limit = min(kBrightest * luminance(media.around) / max(luminance(media.lamps), F(1e-9f)),
                    F(1.0f));
      }
      const Vec3Of<F> light = media.radiance + media.around + media.lamps * limit;
      sum += select<F>(active, throughput * light, Vec3Of<F>{});
      // What brings more light is asked for: the air on the way, or the surface.
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
        // What lamps send to a cell counts where surfaces ask it: no picker is prepared there.
        return count_lamps ? chance_of(scene, *path, row, every, kDrawnLights, i) : 1.0f;
      });
      const F weight = select(first & (pdf > 0.0f),
                              count_lamps ? mis_weight(path->pdf_bsdf, pdf) : F(0.0f), F(1.0f));
      sum += select<F>(shines, throughput * v.emission * (v.opacity * weight), Vec3Of<F>{});
    }
    MaskOf<F> through = false;
    if (scene.has_transparent) {
      const F met = met_share(v);
      const MaskOf<F> thin = active & (met < 1.0f);
      if (any(thin)) through = thin & (path->sampler.next_1d(thin) >= met);
      const Vec3Of<F> share = select<F>(through, passing_light(v) / (1.0f - met),
                                        in_all_lanes<F>({1, 1, 1}) * (v.opacity / met));
      throughput =
          select<F>(thin & (max_component(v.straight) > 0.0f), throughput * share, throughput);
    }
    const Vec3Of<F> wo_W = -path->ray.d;
    FrameOf<F> frame;
    const LayeredBsdfOf<F> bsdf = surface_bsdf(scene, v, wo_W, &frame, active & !through);
    const Vec3Of<F> wo = frame.to_local(wo_W);
    // What glass and mirrors show lies further on.
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
      // No light was drawn for this bounce: what it meets counts in full.
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

}  // namespace fasts

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
    fasts::prepare_picker(scene, r.from, r.normal, active, fasts::kGlowAmongLamps, &path.picker);
  }
  const Vec3Of<F> light =
      fasts::gather(scene, tracer, cache, true, r.flames, !r.flames, active, &path, requests).light;
  *rays += path.result.rays;
  return light;
}

/// What goes on to the camera when the rays have brought the light `seen`.
template <class F>
GLOAM_HD Vec3Of<F> reflected_light(const ReflectionUseOf<F>& r, const Vec3Of<F>& seen) {
  const Vec3Of<F> own = select<F>(r.goes, seen * r.weight, Vec3Of<F>{});
  if (!any(r.borrows)) return own;
  const auto over = [](F x, F y) { return x / max(y, F(1e-6f)); };
  const Vec3Of<F> share{over(own.x, r.albedo.x), over(own.y, r.albedo.y), over(own.z, r.albedo.z)};
  const Vec3Of<F> lent = quad_sums(select<F>(r.together, share, Vec3Of<F>{}));
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
      const auto media =
          fasts::cross_media(scene, tracer, cache, tmax, active, active & !borrows, kSteps, 0, true,
                             &path, requests + 3 * Lanes<F>::kCount);
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
                        kDrawnLights, &diffuse, &specular);
    const Vec2Of<F> u = path.sampler.next_2d(active);
    const Vec3Of<F> jitter{u.x, u.y, path.sampler.next_1d(active)};
    const Mask pane = active & !solid;
    CacheRequest asked[Lanes<F>::kCount];
    const fasts::CachePlaceOf<F> at = fasts::place_of(v);
    const CacheCellOf<F> cells = fasts::ask_cells(cache, at, active, jitter, 0, asked);
    // What the first solid surface has of the cache is looked up when its cells have been traced.
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
    // Of several panes any, by chance.
    const F chosen = passed == 0 ? F(0.0f) : path.sampler.next_1d(pane);
    const Mask one = solid | (pane & (chosen * static_cast<float>(passed + 1) < 1.0f));
    each_lane(one,
              [&](int i) { requests[lane(solid, i) ? i : 2 * Lanes<F>::kCount + i] = asked[i]; });

    if (any(traced)) {
      const Vec2Of<F> toss = path.sampler.next_2d(traced);
      const F pick = path.sampler.next_1d(traced);
      const BsdfSampleOf<F> s = sample_bsdf(shiny, wo, pick, toss);
      const Vec3Of<F> wi = frame.to_world(s.wi);
      const Mask shares = traced & solid & !bsdf.layered & (v.roughness >= kLeastSharedRoughness);
      ReflectionOf<F> r;
      ReflectionUseOf<F>& use = r.use;
      use.together = even_quads<F>(shares, hit.instance, v.normal);
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
