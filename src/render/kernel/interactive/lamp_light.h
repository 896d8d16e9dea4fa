#pragma once
// Direct light of lamps and glowing media at surfaces, in the interactive stage. Device-safe.

#include "render/kernel/interactive/cached_light.h"
#include "render/kernel/interactive/interactive_constants.h"
#include "render/kernel/light/glow_line.h"
#include "render/kernel/math/quads.h"
#include "render/kernel/path/path.h"

namespace gloam::interactive {

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

/// Lanes whose surface is so rough that samples of glowing media make less noise in its reflection
/// than rays do.
template <class F>
GLOAM_HD MaskOf<F> blurs_flames(const SurfaceOf<F>& v, const LayeredBsdfOf<F>& b) {
  const MaskOf<F> sharp =
      (b.p_glass > 0.0f) |
      ((b.p_coat > 0.0f) & (v.coat_roughness < interactive::kLeastSharedRoughness));
  return (v.roughness >= interactive::kLeastSharedRoughness) & !(b.layered & sharp);
}

/// Prepares for lamps, and for glowing media with the probability `glow` where lights are too many
/// to be weighed against them; 0: not at all. The sky's light is the cache's.
template <class F>
GLOAM_HD void prepare_light_sampler(const SceneView& scene, Vec3Of<F> p, Vec3Of<F> n,
                                    MaskOf<F> active, float glow,
                                    LightSamplerOf<F>* light_sampler) {
  light_sampler->prepare(scene, p, n, active);
  light_sampler->leave_out_sky(scene);
  if (glow > 0 && scene.has_glow()) light_sampler->add_glow(scene, active, glow);
}
/// Sample of a lamp, or of media that glow.
template <class F>
struct LampSampleOf {
  LightSampleOf<F> light;
  F clear = 1e30f;  ///< distance beyond which media do not dim it [m]
  MaskOf<F> glows = false;
};

/// Sample of media that glow, from p on a surface with the normal n, or in the air (n = 0), in the
/// `active` lanes.
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

/// Sample of one of all lights and glowing media, as `light_sampler` takes them.
template <class F>
GLOAM_HD LampSampleOf<F> sample_lamp(const SceneView& scene, const LightSamplerOf<F>& light_sampler,
                                     Vec3Of<F> p, Vec3Of<F> n, Vec2Of<F> u, F time,
                                     MaskOf<F> active) {
  LampSampleOf<F> out;
  if (!scene.has_glow()) {
    out.light = light_sampler.sample(scene, p, u, time, active);
    return out;
  }
  const F probability = light_sampler.glow_probability();
  const MaskOf<F> glows = active & (u.x < probability);
  out.light = light_sampler.sample(scene, p, u, time, active & !glows);
  sample_glow(scene, p, n, Vec2Of<F>{rest_of(u.x, F(0.0f), probability), u.y}, glows, &out);
  out.light.pdf = select(glows, out.light.pdf * probability, out.light.pdf);
  return out;
}

/// Surface that a ray has met, and its BSDF there: references, as copies in lanes cost time.
template <class F>
struct LitSurfaceOf {
  const SurfaceOf<F>& v;
  const FrameOf<F>& frame;  ///< of the BSDF
  const LayeredBsdfOf<F>& bsdf;
  const LayeredBsdfOf<F>& shiny;  ///< bsdf without its diffuse parts
  Vec3Of<F> wo;                   ///< towards the ray's origin, in `frame`, unit
};

/// Samples that direct_light() takes.
template <class F>
struct LampOptionsOf {
  MaskOf<F> active = true;
  LampListsOf<F> lists = {};  ///< lanes with one have their lamps from it
  /// Lanes whose specular ray may find the lamp too, if it has an extent; of glowing media either
  /// that ray or this sample shows the reflection.
  MaskOf<F> traced = false;
  MaskOf<F> borrows = false;  ///< lanes that take the transmittance of media of the lane beside
  bool every = false;         ///< a sample of each light, and of glowing media
  uint32_t samples = 1;       ///< else, of lights
};

/// Direct light.
template <class F>
struct LampLightOf {
  Vec3Of<F> diffuse;   ///< over the diffuse albedo [cd/m²]
  Vec3Of<F> specular;  ///< [cd/m²]
};

/// Probability with which surfaces at p sample a lamp that moves, by its light from all around over
/// the brightest of their lists.
template <class F>
GLOAM_HD F movable_probability(const SceneView& scene, const LampListsOf<F>& lists, uint32_t row,
                               Vec3Of<F> p, MaskOf<F> active) {
  const F weight = light_weight(scene, scene.lights[row], p, Vec3Of<F>{});
  F brightest = 0.0f;
  each_lane(active, [&](int i) { set_lane(&brightest, i, lists.of[i]->brightest); });
  return min(weight / max(brightest * interactive::kSureLamp, F(1e-30f)), F(1.0f));
}

/// Sum over samples of lamps at vertices, before media on the way of their light.
template <class F, class Tracer>
class LampSum {
 public:
  GLOAM_HD LampSum(const InteractiveWorld<Tracer>& world, const LitSurfaceOf<F>& surface,
                   const LampOptionsOf<F>& options, paths::State<F>* path)
      : world_(world), s_(surface), options_(options), path_(*path) {}

  /// Adds a sample for the `active` lanes; in the `clear` ones only what may move can hide it.
  [[gnu::always_inline]] GLOAM_HD void add(const LampSampleOf<F>& lamp, MaskOf<F> active,
                                           MaskOf<F> clear = false) {
    const LightSampleOf<F>& light = lamp.light;
    const SurfaceOf<F>& v = s_.v;
    MaskOf<F> lit = active & (light.pdf > 0.0f) & (dot(light.wi, v.geometric) > 0.0f);
    if (!any(lit)) return;
    const Vec3Of<F> wi = s_.frame.to_local(light.wi);
    lit = lit & (wi.z > 0.0f);
    F pdf;
    const Vec3Of<F> f = eval_bsdf(s_.shiny, s_.wo, wi, &pdf);
    const F seen = select(blurs_flames(v, s_.shiny), F(1.0f), F(0.0f));
    const F weight = select(options_.traced & !light.is_delta,
                            select(lamp.glows, seen, mis_weight(light.pdf, pdf)), F(1.0f));
    RayOf<F> shadow = path_.ray;
    aim_shadow_ray(v.p, v.geometric, v.t, light, &shadow);
    Vec3Of<F> arriving = light.radiance * (1.0f / light.pdf);
    if (const MaskOf<F> shadowed = lit & light.casts_shadow & !clear; any(shadowed)) {
      const Vec3Of<F> passed =
          paths::transmit(world_.scene, world_.tracer, shadow, shadowed, &path_.result.rays);
      arriving = select<F>(shadowed, arriving * passed, arriving);
    }
    if (const MaskOf<F> open = lit & light.casts_shadow & clear; any(open)) {
      const Vec3Of<F> passed =
          paths::transmit(world_.scene, *world_.movers, shadow, open, &path_.result.rays);
      arriving = select<F>(open, arriving * passed, arriving);
    }
    light_.diffuse += select<F>(lit, arriving * (wi.z * kInvPi), Vec3Of<F>{});
    light_.specular += select<F>(lit, arriving * f * weight, Vec3Of<F>{});
    if (world_.scene.has_media()) choose_way(lamp, lit, arriving, wi.z, shadow);
  }

  /// Light after media: they take from all samples what they take from the one chosen.
  GLOAM_HD LampLightOf<F> finish() {
    const MaskOf<F> lit = options_.active & (total_ > 0.0f);
    const MaskOf<F> borrows = options_.borrows & (flip<1>(total_) > 0.0f);
    Vec3Of<F> passed = paths::through_media(world_.scene, way_, lit & !borrows, &path_.sampler);
    passed = select<F>(borrows, flip<1>(passed), passed);
    return {light_.diffuse * passed, light_.specular * passed};
  }

 private:
  /// Chooses the shadow ray of this sample for all so far, in proportion to its light.
  GLOAM_HD void choose_way(const LampSampleOf<F>& lamp, MaskOf<F> lit, const Vec3Of<F>& arriving,
                           F cosine, const RayOf<F>& shadow) {
    const F illuminance = select(lit, luminance(arriving) * cosine, F(0.0f));
    total_ += illuminance;
    const MaskOf<F> taken = path_.sampler.next_1d(lit) * total_ < illuminance;
    way_.o = select<F>(taken, shadow.o, way_.o);
    way_.d = select<F>(taken, shadow.d, way_.d);
    way_.tmax = select(taken, min(shadow.tmax, lamp.clear), way_.tmax);
  }

  const InteractiveWorld<Tracer>& world_;
  const LitSurfaceOf<F>& s_;
  const LampOptionsOf<F>& options_;
  paths::State<F>& path_;
  LampLightOf<F> light_;
  RayOf<F> way_;    ///< shadow ray of the sample chosen
  F total_ = 0.0f;  ///< illuminance of all samples [lx]
};

/// Adds the lamps that move to the sum: no list holds them. Lamps that are weak beside the lists'
/// are sampled by chance.
template <class F, class Tracer>
GLOAM_HD void add_movable_lamps(const InteractiveWorld<Tracer>& world, const LampListsOf<F>& lists,
                                const SurfaceOf<F>& v, MaskOf<F> active, paths::State<F>* path,
                                LampSum<F, Tracer>* sum) {
  for (uint32_t k = 0; k < world.lamps->movable.size; ++k) {
    const uint32_t row = world.lamps->movable[k];
    const F probability = movable_probability(world.scene, lists, row, v.p, active);
    const MaskOf<F> taken = active & (path->sampler.next_1d(active) < probability);
    if (!any(taken)) continue;
    LampSampleOf<F> lamp;
    lamp.light = sample_one_light(world.scene, row, v.p, path->sampler.next_2d(taken),
                                  path->ray.time, taken);
    lamp.light.pdf *= probability;
    sum->add(lamp, taken);
  }
}

/// Adds the lamps of the lanes' lists: all of them, or of long lists some samples.
template <class F, class Tracer>
GLOAM_HD void add_listed_lamps(const InteractiveWorld<Tracer>& world, const LampListsOf<F>& lists,
                               const SurfaceOf<F>& v, MaskOf<F> active, paths::State<F>* path,
                               LampSum<F, Tracer>* sum) {
  const SceneView& scene = world.scene;
  MaskOf<F> few = false;
  each_lane(active, [&](int i) {
    set_lane(&few, i, lists.of[i]->visible <= interactive::kMaxLampsOfSurface);
  });
  ListedLamps<F> lamps(lists, few);
  for (ListedLampOf<F> one; lamps.next(&one);) {
    LampSampleOf<F> lamp;
    lamp.light = sample_one_light(scene, one.lamp, v.p, path->sampler.next_2d(one.lanes),
                                  path->ray.time, one.lanes);
    sum->add(lamp, one.lanes, one.clear);
  }
  const MaskOf<F> many = active & !few;
  for (uint32_t k = 0; k < interactive::kSampledLights && any(many); ++k) {
    Vec2Of<F> u = path->sampler.next_2d(many);
    u.x = (u.x + static_cast<float>(k)) * (1.0f / static_cast<float>(interactive::kSampledLights));
    LampSampleOf<F> lamp;
    lamp.light.pdf = 0.0f;
    MaskOf<F> clear = false;
    each_lane(many, [&](int i) {
      const LampDraw draw = draw_lamp(*lists.of[i], lane(u.x, i));
      if (!(draw.probability > 0)) return;
      LightSample light = sample_one_light<float>(
          scene, draw.lamp, lane(v.p, i), {draw.rest, lane(u.y, i)}, lane(path->ray.time, i), true);
      light.pdf *= draw.probability * static_cast<float>(interactive::kSampledLights);
      set_lane(&lamp.light, i, light);
      set_lane(&clear, i, draw.clear);
    });
    sum->add(lamp, many, clear);
  }
  if (!world.lamps->movable.empty()) add_movable_lamps(world, lists, v, active, path, sum);
}

/// Adds samples of all lights, chosen at the surface itself.
template <class F, class Tracer>
GLOAM_HD void add_any_lamps(const InteractiveWorld<Tracer>& world, const LampOptionsOf<F>& options,
                            const SurfaceOf<F>& v, MaskOf<F> active, paths::State<F>* path,
                            LampSum<F, Tracer>* sum) {
  const SceneView& scene = world.scene;
  const float glow = options.every ? 0.0f
                                   : (options.samples > 1 ? interactive::kGlowAmongLamps
                                                          : interactive::kGlowProbability);
  prepare_light_sampler(scene, v.p, v.geometric, active, glow, &path->light_sampler);
  const uint32_t samples = options.every ? scene.lights.size : options.samples;
  for (uint32_t k = 0; k < samples; ++k) {
    Vec2Of<F> u = path->sampler.next_2d(active);
    LampSampleOf<F> lamp;
    if (options.every) {
      const MaskOf<F> near = active & (path->light_sampler.probabilities(k) > 0.0f);
      if (!any(near)) continue;
      lamp.light = sample_one_light(scene, k, v.p, u, path->ray.time, near);
      lamp.light.pdf = select(near, lamp.light.pdf, F(0.0f));
    } else {
      u.x = (u.x + static_cast<float>(k)) * (1.0f / static_cast<float>(samples));
      lamp = sample_lamp(scene, path->light_sampler, v.p, v.geometric, u, path->ray.time, active);
      lamp.light.pdf *= static_cast<float>(samples);
    }
    sum->add(lamp, active);
  }
}

/// Direct light at the surfaces of the active lanes: of every light and glowing medium, or of some
/// samples of them all.
template <class F, class Tracer>
GLOAM_HD_LARGE LampLightOf<F> direct_light(const InteractiveWorld<Tracer>& world,
                                           const LitSurfaceOf<F>& surface,
                                           const LampOptionsOf<F>& options, paths::State<F>* path) {
  const SceneView& scene = world.scene;
  const SurfaceOf<F>& v = surface.v;
  const MaskOf<F> active = options.active, listed = active & options.lists.known;
  LampSum<F, Tracer> sum(world, surface, options, path);
  if (scene.has_glow()) {
    const MaskOf<F> always = active & MaskOf<F>(options.every || scene.lights.size == 0);
    const F probability = select(always, F(1.0f), F(interactive::kGlowAmongLamps));
    const MaskOf<F> glows =
        always | (listed & (path->sampler.next_1d(listed) < interactive::kGlowAmongLamps));
    LampSampleOf<F> lamp;
    lamp.light.pdf = 0.0f;
    sample_glow(scene, v.p, v.geometric, path->sampler.next_2d(glows), glows, &lamp);
    lamp.light.pdf *= probability;
    sum.add(lamp, glows);
  }
  if (scene.lights.size == 0) return sum.finish();
  if (any(listed)) add_listed_lamps(world, options.lists, v, listed, path, &sum);
  const MaskOf<F> others = active & !listed;
  if (any(others)) add_any_lamps(world, options, v, others, path, &sum);
  return sum.finish();
}

/// Number of samples with which direct_light() at a surface in view takes the light of a row, in
/// the mean, for lane i.
template <class F, class Tracer>
GLOAM_HD float lamp_probability(const InteractiveWorld<Tracer>& world, const LampListsOf<F>& lists,
                                const paths::State<F>& path, uint32_t row, int i) {
  if (const LampCell* cell = lists.of[i]; cell != nullptr) {
    for (uint32_t k = 0; k < world.lamps->movable.size; ++k) {
      if (world.lamps->movable[k] != row) continue;
      LampListsOf<float> one;
      one.set(0, cell);
      return movable_probability<float>(world.scene, one, row, lane(path.from, i), true);
    }
    const float drawn = draw_probability(*cell, row);
    if (cell->visible <= interactive::kMaxLampsOfSurface) return drawn > 0 ? 1.0f : 0.0f;
    return static_cast<float>(interactive::kSampledLights) * drawn;
  }
  if (world.scene.lights.size <= interactive::kMaxFastLights) return 1.0f;
  return static_cast<float>(interactive::kSampledLights) *
         path.light_sampler.probability(world.scene, row, i);
}

/// Light of lamps' spheres and of suns that path.ray meets before `tmax`, weighted against
/// direct_light() at path.from, where the lanes have `lists`.
template <class F, class Tracer>
GLOAM_HD Vec3Of<F> lamps_met(const InteractiveWorld<Tracer>& world, const LampListsOf<F>& lists,
                             const paths::State<F>& path, F tmax, MaskOf<F> active) {
  const SceneView& scene = world.scene;
  const auto clear = [](int, float) { return Vec3f{1, 1, 1}; };
  Vec3Of<F> sum;
  if (scene.lights.size <= interactive::kMaxFastLights) {
    for (uint32_t i = 0; i < scene.lights.size; ++i) {
      sum += visible_light(
          scene, i, path.ray, tmax, path.from, path.pdf_bsdf, active,
          [&] {
            F probability = 1.0f;
            each_lane(active & lists.known, [&](int at) {
              set_lane(&probability, at, lamp_probability(world, lists, path, i, at));
            });
            return probability;
          },
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
          [&] { return lamp_probability(world, lists, path, i, at); }, clear);
    });
    set_lane(&sum, at, light);
  });
  return sum;
}

}  // namespace gloam::interactive
