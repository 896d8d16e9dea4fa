#pragma once
// Scattering and emission of media along a ray, in the interactive stage. Device-safe.

#include "render/kernel/interactive/cached_light.h"
#include "render/kernel/interactive/lamp_light.h"
#include "render/kernel/media/medium_march.h"

namespace gloam::interactive {

/// Sample of lamps for a step of a ray through media.
struct AirLamp {
  LampSampleOf<float> lamp;
  Vec3f p_W;    ///< in the step
  Vec3f light;  ///< that it brings to the ray's origin if nothing is in between [cd/m²]
};

/// Sample of lamps for media at p_W on the ray. `weight`: MarchStep::weight.
GLOAM_HD AirLamp sample_air(const SceneView& scene, const Ray& ray, const MediumPoint& medium,
                            Vec3f weight, Vec3f p_W, Vec2f u) {
  AirLamp out{{}, p_W, {}};
  LightSampler light_sampler;
  prepare_light_sampler<float>(scene, p_W, Vec3f{}, true, interactive::kGlowProbability,
                               &light_sampler);
  out.lamp = sample_lamp<float>(scene, light_sampler, p_W, Vec3f{}, u, ray.time, true);
  const LightSample& light = out.lamp.light;
  const bool has_surface = length_squared(light.lift) > 0;
  if (!(light.pdf > 0) || (has_surface && light.distance < interactive::kNearLamp)) return out;
  const float cosine = dot(ray.d, light.wi);
  const auto phase = [&](float scattering, float g_scattering) {
    const float g = scattering > 0 ? g_scattering / scattering : 0.0f;
    return scattering * henyey_greenstein(g, cosine);
  };
  const Vec3f s = medium.scattering, g = medium.g_scattering;
  out.light = Vec3f{phase(s.x, g.x), phase(s.y, g.y), phase(s.z, g.z)} * weight * light.radiance /
              light.pdf;
  return out;
}

/// Transmittance from the lamp of a sample to its place in the air.
template <class Tracer>
GLOAM_HD Vec3f transmittance_to(const SceneView& scene, const Tracer& tracer, const Ray& ray,
                                const AirLamp& air, WalkRandom* random, uint32_t* rays) {
  Ray shadow = ray;
  aim_shadow_ray(air.p_W, Vec3f{}, 0.0f, air.lamp.light, &shadow);
  Vec3f passed{1, 1, 1};
  if (air.lamp.light.casts_shadow) passed = paths::transmit(scene, tracer, shadow, true, rays);
  if (!(max_component(passed) > 0)) return {};
  return passed * transmittance(scene.media, shadow, min(shadow.tmax, air.lamp.clear), {}, *random);
}

/// Light of lamps that media of the mean cosine g at ray.o would scatter against the ray: of even
/// surroundings as bright [cd/m²].
template <class Tracer>
GLOAM_HD Vec3f lamps_in_air(const SceneView& scene, const Tracer& tracer, const Ray& ray, float g,
                            Vec2f u, WalkRandom* random, uint32_t* rays) {
  MediumPoint one;
  one.scattering = {1, 1, 1};
  one.g_scattering = {g, g, g};
  const AirLamp lamp = sample_air(scene, ray, one, {1, 1, 1}, ray.o, u);
  if (!(max_component(lamp.light) > 0)) return {};
  return lamp.light * transmittance_to(scene, tracer, ray, lamp, random, rays);
}

/// The cell of a key, or the one behind the walls that hide p_W from that.
struct AirCell {
  uint64_t key;
  int row;  ///< -1: its light is not known yet
};
template <class Tracer>
GLOAM_HD AirCell find_air(const Tracer& tracer, const IrradianceCacheView& cache, uint64_t key,
                          Vec3f p_W) {
  for (uint32_t walls = 0; walls < 2; ++walls, key = caches::hidden(key)) {
    const int row = find_known_cell(cache, key);
    if (row < 0 || caches::is_seen(tracer, cache.homes[static_cast<uint32_t>(row)], p_W)) {
      return {key, row};
    }
  }
  return {0, -1};
}

/// Light that media at a place scatter against a ray: of even surroundings as bright [cd/m²].
struct AirLight {
  Vec3f all, lamps;  ///< lamps: of that
};
/// Light for media of the mean cosine g at p_W and a ray along d: of the cache's cell of the air
/// there, or `otherwise`.
template <class Tracer>
GLOAM_HD AirLight air_light(const Tracer& tracer, const IrradianceCacheView& cache, Vec3f p_W,
                            Vec3f d, float g, uint32_t coarser, const AirLight& otherwise,
                            WalkRandom* random, CacheRequest* request) {
  // Larger cells are asked for, too, to stand for those that are not there yet.
  const auto cell_for = [&](Vec3f jitter, uint32_t level) {
    return find_air(tracer, cache, cache_key(cache, p_W, d, kAirCell, jitter, level), p_W);
  };
  const Vec3f jitter{random->next(), random->next(), random->next()}, middle{0.5f, 0.5f, 0.0f};
  AirCell cell = cell_for(jitter, coarser);
  *request = {cell.key, p_W, d, g};
  if (random->next() < interactive::kCoarserCellProbability)
    request->key = cell_for(middle, coarser + interactive::kCoarserCellLevels).key;
  for (uint32_t more = 0; cell.row < 0 && more <= interactive::kCoarserCellLevels; ++more) {
    cell = cell_for(middle, coarser + more);
  }
  if (cell.row < 0) return otherwise;
  const CellLight& light = cache.light[static_cast<uint32_t>(cell.row)];
  return {light.all, light.near};
}

/// Emission that samples of lamps leave out: of media right before the ray [cd/m²].
GLOAM_HD Vec3f near_glow(const MediaView& media, const Ray& ray) {
  return march(media, ray, min(ray.tmax, glow::kNearGlow), 0.0f, interactive::kNearGlowSteps, {},
               true, [](const MarchStep&) { return Vec3f{}; })
      .radiance;
}

/// Part of near_glow() that a medium of the mean cosine g at p_W scatters against a ray along d, by
/// one sample.
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

/// Choice of some of many items, as many as their probabilities add up to, evenly spread.
struct EvenChoice {
  float sum;  ///< of the probabilities since the last item taken; at first by chance, in [0, 1)
  GLOAM_HD bool takes(float probability) {
    sum += probability;
    if (sum < 1) return false;
    sum -= 1;
    return true;
  }
};

/// Light of media along path->ray up to `tmax`: scattered once from lamps, scattered from all
/// around, emitted, and let through.
template <class F>
struct MediaLightOf {
  Vec3Of<F> radiance;   ///< emitted [cd/m²]
  Vec3Of<F> around;     ///< scattered from all around [cd/m²]
  Vec3Of<F> lamps;      ///< scattered from lamps: one sample of one place [cd/m²]
  Vec3Of<F> scattered;  ///< fraction of the light that arrives from all around
  Vec3Of<F> through;    ///< transmittance
};

/// Media that cross_media() takes into account.
template <class F>
struct MediaOptionsOf {
  F tmax = 1e30f;  ///< [m]
  int steps = 1;
  uint32_t coarser = 0;  ///< doublings of the cells' edges
  MaskOf<F> active = true;
  MaskOf<F> samples_lamps = false;  ///< lanes that sample lamps; else the cache's light counts
  MaskOf<F> flames = true;          ///< lanes in which emission counts
};

/// Media along one ray of the interactive stage.
template <class Tracer>
class AirRay {
 public:
  /// Options of MediaOptionsOf in one lane.
  struct Options {
    float tmax;  ///< [m]
    int steps;
    uint32_t coarser;
    bool samples_lamps, flames;
  };
  GLOAM_HD AirRay(const InteractiveWorld<Tracer>& world, const Ray& ray, const Options& options,
                  Vec2f u)
      : world_(world),
        ray_(ray),
        options_(options),
        random_(u),
        choice_{random_.next()},
        air_{world.cache.mean, {}} {}

  /// Marches through the media; `request`: of one of the places that scatter light.
  GLOAM_HD MarchResult march_through(CacheRequest* request) {
    return march(world_.scene.media, ray_, options_.tmax, 0.0f, options_.steps, {}, options_.flames,
                 [&](const MarchStep& step) {
                   take_step(step, request);
                   return Vec3f{};
                 });
  }
  GLOAM_HD Vec3f around() const { return around_; }

  /// Light of lamps [cd/m²], after march_through(), by one of the steps kept.
  GLOAM_HD Vec3f sample_lamps(uint32_t* rays) {
    if (!(options_.samples_lamps && in_all_ > 0)) return {};
    AirLamp lamps[interactive::kLampSteps];
    float light[interactive::kLampSteps], all = 0;
    for (int k = 0; k < interactive::kLampSteps; ++k) {
      const Vec3f weight = kept_[k].weight * (in_all_ / kept_[k].brings);
      lamps[k] = sample_air(world_.scene, ray_, kept_[k].point, weight, kept_[k].p_W,
                            {random_.next(), random_.next()});
      light[k] = luminance(lamps[k].light);
      all += light[k];
    }
    if (!(all > 0)) return {};
    // Probability half even, half by the light: the brighter sample may be hidden.
    const float first = 0.25f + 0.5f * light[0] / all;
    const int k = random_.next() < first ? 0 : 1;
    const Vec3f passed =
        transmittance_to(world_.scene, world_.tracer, ray_, lamps[k], &random_, rays);
    const float probability = k == 0 ? first : 1 - first;
    return lamps[k].light * passed * (0.5f / probability);
  }

 private:
  /// Step that takes a sample of lamps.
  struct LampStep {
    MediumPoint point;
    Vec3f p_W, weight;
    float brings = 0;
  };

  GLOAM_HD void take_step(const MarchStep& step, CacheRequest* request) {
    const MediumPoint& point = step.medium;
    const Vec3f p_W = ray_.o + ray_.d * place_in(step, random_.next());
    const Vec3f scattered = point.scattering * step.weight;
    const float scatters = max_component(scattered);
    // Some steps ask the cache, the fewer the less they scatter, and count for as many more.
    if (const float probability = min(scatters / interactive::kCertainScattering, 1.0f);
        choice_.takes(probability)) {
      CacheRequest asked;
      const float g = luminance(point.g_scattering) / luminance(point.scattering);
      air_ = air_light(world_.tracer, world_.cache, p_W, ray_.d, g, options_.coarser, air_,
                       &random_, &asked);
      Vec3f from_all = options_.samples_lamps ? air_.all - air_.lamps : air_.all;
      if (step.is_hot) {
        from_all += near_glow_in_air(world_.scene.media, p_W, ray_.d, g, &random_);
      }
      around_ += scattered * from_all * (1 / probability);
      weight_asked_ += scatters / probability;
      if (random_.next() * weight_asked_ < scatters / probability) *request = asked;
    }
    const float brings =
        scatters * luminance(air_.all * interactive::kUniformLampWeight + air_.lamps);
    in_all_ += brings;
    for (LampStep& one : kept_) {
      if (random_.next() * in_all_ < brings) one = {point, p_W, step.weight, brings};
    }
  }

  const InteractiveWorld<Tracer>& world_;
  const Ray& ray_;
  const Options& options_;
  WalkRandom random_;
  EvenChoice choice_;
  AirLight air_;            ///< of the last step that the cache knew
  float weight_asked_ = 0;  ///< scattered fraction of the steps that have asked
  float in_all_ = 0;        ///< light that lamps may bring to all steps
  Vec3f around_;            ///< scattered from all around [cd/m²]
  LampStep kept_[interactive::kLampSteps];
};

/// Light of media along path->ray. `requests`: one per lane.
template <class F, class Tracer>
GLOAM_HD_LARGE MediaLightOf<F> cross_media(const InteractiveWorld<Tracer>& world,
                                           const MediaOptionsOf<F>& options, paths::State<F>* path,
                                           CacheRequest* requests) {
  MediaLightOf<F> out{{}, {}, {}, {}, in_all_lanes<F>({1, 1, 1})};
  if (world.scene.media.volumes.empty()) return out;
  const Vec2Of<F> u = path->sampler.next_2d(options.active);
  each_lane(options.active, [&](int i) {
    const Ray ray = lane(path->ray, i);
    const typename AirRay<Tracer>::Options one{lane(options.tmax, i), options.steps,
                                               options.coarser, lane(options.samples_lamps, i),
                                               lane(options.flames, i)};
    AirRay<Tracer> air(world, ray, one, lane(u, i));
    const MarchResult m = air.march_through(&requests[i]);
    uint32_t rays = 0;
    set_lane(&out.lamps, i, air.sample_lamps(&rays));
    set_lane(&path->result.rays, i, lane(path->result.rays, i) + rays);
    set_lane(&out.radiance, i, m.radiance);
    set_lane(&out.around, i, air.around());
    set_lane(&out.scattered, i, m.scattered);
    set_lane(&out.through, i, m.transmittance);
  });
  return out;
}

}  // namespace gloam::interactive
