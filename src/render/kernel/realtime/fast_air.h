#pragma once
// Scattering and emission of media along a ray, in the fast stage. Device-safe.

#include "render/kernel/media/medium_march.h"
#include "render/kernel/realtime/fast_cache.h"
#include "render/kernel/realtime/fast_lamps.h"

namespace gloam::fasts {

/// A sample of lamps for a step of a ray through media.
struct AirLamp {
  LampSampleOf<float> lamp;
  Vec3f p_W;    ///< in the step
  Vec3f light;  ///< that it brings to the ray's origin if nothing is in between [cd/m²]
};

/// Distance from air [m] below which a lamp's surface lights it by the rays of the cache's cells
/// alone: samples of points of a large lamp grow without bound as they come nearer.
inline constexpr float kNearLamp = 0.25f;

/// Sample of lamps for media at p_W on the ray. `weight`: MarchStep::weight.
GLOAM_HD AirLamp sample_air(const SceneView& scene, const Ray& ray, const MediumPoint& medium,
                            Vec3f weight, Vec3f p_W, Vec2f u) {
  AirLamp out{{}, p_W, {}};
  LightSampler light_sampler;
  prepare_light_sampler<float>(scene, p_W, Vec3f{}, true, kOneGlow, &light_sampler);
  out.lamp = sample_lamp<float>(scene, light_sampler, p_W, Vec3f{}, u, ray.time, true);
  const LightSample& light = out.lamp.light;
  const bool has_surface = length_squared(light.lift) > 0;
  if (!(light.pdf > 0) || (has_surface && light.distance < kNearLamp)) return out;
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
  constexpr float kLarger = 0.125f;
  constexpr uint32_t kLevels = 2;
  const auto cell_for = [&](Vec3f jitter, uint32_t level) {
    return find_air(tracer, cache, cache_key(cache, p_W, d, kAirCell, jitter, level), p_W);
  };
  const Vec3f jitter{random->next(), random->next(), random->next()}, middle{0.5f, 0.5f, 0.0f};
  AirCell cell = cell_for(jitter, coarser);
  *request = {cell.key, p_W, d, g};
  if (random->next() < kLarger) request->key = cell_for(middle, coarser + kLevels).key;
  for (uint32_t more = 0; cell.row < 0 && more <= kLevels; ++more) {
    cell = cell_for(middle, coarser + more);
  }
  if (cell.row < 0) return otherwise;
  const CellLight& light = cache.light[static_cast<uint32_t>(cell.row)];
  return {light.all, light.near};
}

/// Emission that samples of lamps leave out: of media right before the ray [cd/m²].
GLOAM_HD Vec3f near_glow(const MediaView& media, const Ray& ray) {
  constexpr int kSteps = 4;
  return march(media, ray, min(ray.tmax, glow::kNearGlow), 0.0f, kSteps, {}, true,
               [](const MarchStep&) { return Vec3f{}; })
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

/// Light of media along path->ray up to `tmax`: scattered once from lamps, scattered from all
/// around, emitted, and let through.
template <class F>
struct MediaLightOf {
  Vec3Of<F> radiance;   ///< that they give off [cd/m²]
  Vec3Of<F> around;     ///< scattered from all around [cd/m²]
  Vec3Of<F> lamps;      ///< scattered from lamps: one sample of one place [cd/m²]
  Vec3Of<F> scattered;  ///< fraction of the light that arrives from all around
  Vec3Of<F> through;
};
/// `samples`: lanes that take a sample of lamps; in others the cache's light of lamps counts.
/// `glows`: what glows on the way counts. `requests`:
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
    constexpr float kOfAir = 0.1f;
    Turn of_air{random.next()};
    float weighed = 0;             // what has been asked for
    float in_all = 0;              // what lamps may bring
    AirLight air{cache.mean, {}};  // of the last step that the cache knew
    Vec3f around;
    // Two steps, by what they scatter, take a sample of lamps, and one of these stands for all.
    constexpr int kSampled = 2;
    constexpr float kEven = 0.1f;  // of what all light brings counts, as lamps may move
    struct {
      MediumPoint point;
      Vec3f p_W, weight;
      float brings = 0;
    } sampled[kSampled];
    const MarchResult m =
        march(scene.media, ray, lane(tmax, i), 0.0f, steps, {}, lane(glows, i),
              [&](const MarchStep& step) {
                const MediumPoint& point = step.medium;
                const Vec3f p_W = ray.o + ray.d * place_in(step, random.next());
                const Vec3f scattered = point.scattering * step.weight;
                const float scatters = max_component(scattered);
                if (const float chance = min(scatters / kOfAir, 1.0f); of_air.comes(chance)) {
                  CacheRequest request;
                  const float g = luminance(point.g_scattering) / luminance(point.scattering);
                  air = air_light(tracer, cache, p_W, ray.d, g, coarser, air, &random, &request);
                  Vec3f from_all = lane(samples, i) ? air.all - air.lamps : air.all;
                  if (step.is_hot)
                    from_all += near_glow_in_air(scene.media, p_W, ray.d, g, &random);
                  around += scattered * from_all * (1 / chance);
                  weighed += scatters / chance;
                  if (random.next() * weighed < scatters / chance) requests[i] = request;
                }
                const float brings = scatters * luminance(air.all * kEven + air.lamps);
                in_all += brings;
                for (auto& one : sampled) {
                  if (random.next() * in_all < brings) one = {point, p_W, step.weight, brings};
                }
                return Vec3f{};
              });
    if (lane(samples, i) && in_all > 0) {
      // Probability half even, half by the light: the brighter sample may be hidden.
      AirLamp lamps[kSampled];
      float light[kSampled], all = 0;
      for (int k = 0; k < kSampled; ++k) {
        const Vec3f weight = sampled[k].weight * (in_all / sampled[k].brings);
        lamps[k] = sample_air(scene, ray, sampled[k].point, weight, sampled[k].p_W,
                              {random.next(), random.next()});
        light[k] = luminance(lamps[k].light);
        all += light[k];
      }
      if (all > 0) {
        const float first = 0.25f + 0.5f * light[0] / all;
        const int k = random.next() < first ? 0 : 1;
        uint32_t rays = 0;
        const Vec3f passed = transmittance_to(scene, tracer, ray, lamps[k], &random, &rays);
        const float chance = k == 0 ? first : 1 - first;
        set_lane(&out.lamps, i, lamps[k].light * passed * (0.5f / chance));
        set_lane(&path->result.rays, i, lane(path->result.rays, i) + rays);
      }
    }
    set_lane(&out.radiance, i, m.radiance);
    set_lane(&out.around, i, around);
    set_lane(&out.scattered, i, m.scattered);
    set_lane(&out.through, i, m.transmittance);
  });
  return out;
}

}  // namespace gloam::fasts
