#pragma once
// Direct light of lamps and glowing media at surfaces, in the fast stage. Device-safe.

#include "render/kernel/light/glow_line.h"
#include "render/kernel/math/quads.h"
#include "render/kernel/path/path.h"

namespace gloam {

/// Scenes with more lights than this sample so many of them at each surface.
inline constexpr uint32_t kMaxFastLights = kMaxWeighedLights, kSampledLights = 4;
/// Surfaces rougher than this reflect the light of the cache instead of what a ray finds: that is
/// of all directions alike.
inline constexpr float kMaxTracedRoughness = 0.6f;
/// Roughness from which one pixel of two by two traces a reflection ray for all: the reflection is
/// blurred over more than these pixels.
inline constexpr float kLeastSharedRoughness = 0.2f;

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

/// Lanes whose surface is so rough that samples of glowing media make less noise in its reflection
/// than rays do.
template <class F>
GLOAM_HD MaskOf<F> blurs_flames(const SurfaceOf<F>& v, const LayeredBsdfOf<F>& b) {
  const MaskOf<F> sharp =
      (b.p_glass > 0.0f) | ((b.p_coat > 0.0f) & (v.coat_roughness < kLeastSharedRoughness));
  return (v.roughness >= kLeastSharedRoughness) & !(b.layered & sharp);
}

/// For lamps, and for what glows with the probability `glow` where lights are too many to be
/// weighed against it; 0: not at all. The sky is the cache's.
template <class F>
GLOAM_HD void prepare_light_sampler(const SceneView& scene, Vec3Of<F> p, Vec3Of<F> n,
                                    MaskOf<F> active, float glow,
                                    LightSamplerOf<F>* light_sampler) {
  light_sampler->prepare(scene, p, n, active);
  light_sampler->leave_out_sky(scene);
  if (glow > 0 && scene.has_glow()) light_sampler->add_glow(scene, active, glow);
}
/// Where one sample is taken, and of the samples at a surface.
inline constexpr float kOneGlow = 0.5f, kGlowAmongLamps = 1.0f / kSampledLights;

/// A sample of a lamp, or of what glows.
template <class F>
struct LampSampleOf {
  LightSampleOf<F> light;
  F clear = 1e30f;  ///< what is farther away than this does not dim it [m]
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

/// One of all, as `light_sampler` takes them.
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
    const Vec3Of<F> passed = paths::transmit(scene, tracer, shadow, shadowed, &path->result.rays);
    arriving = select<F>(shadowed, arriving * passed, arriving);
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
/// are few lights, or of `samples` of them all. Media take from all what they take from one, in the
/// `borrows` lanes from one of the lane beside.
template <class F, class Tracer>
GLOAM_HD void direct_light(const SceneView& scene, const Tracer& tracer, paths::State<F>* path,
                           const SurfaceOf<F>& v, const LayeredBsdfOf<F>& shiny,
                           const FrameOf<F>& frame, Vec3Of<F> wo, MaskOf<F> traced,
                           MaskOf<F> active, MaskOf<F> borrows, bool every, uint32_t samples,
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
    const float glow = every ? 0.0f : (samples > 1 ? kGlowAmongLamps : kOneGlow);
    prepare_light_sampler(scene, v.p, v.geometric, active, glow, &path->light_sampler);
  }
  if (every || scene.lights.size == 0) samples = scene.lights.size;
  for (uint32_t k = 0; k < samples; ++k) {
    Vec2Of<F> u = path->sampler.next_2d(active);
    LampSampleOf<F> lamp;
    if (every) {
      const MaskOf<F> near = active & (path->light_sampler.probabilities(k) > 0.0f);
      if (!any(near)) continue;
      lamp.light = sample_one_light(scene, k, v.p, u, path->ray.time, near);
      lamp.light.pdf = select(near, lamp.light.pdf, F(0.0f));
    } else {
      u.x = (u.x + static_cast<float>(k)) * (1.0f / static_cast<float>(samples));
      lamp = sample_lamp(scene, path->light_sampler, v.p, v.geometric, u, path->ray.time, active);
      lamp.light.pdf *= static_cast<float>(samples);
    }
    add(lamp);
  }
  const MaskOf<F> lit = active & (sum.total > 0.0f);
  borrows = borrows & (flip<1>(sum.total) > 0.0f);
  Vec3Of<F> transmittance = paths::through_media(scene, sum.way, lit & !borrows, &path->sampler);
  transmittance = select<F>(borrows, flip<1>(transmittance), transmittance);
  *diffuse = sum.diffuse * transmittance;
  *specular = sum.specular * transmittance;
}

/// Probability with which direct_light() takes the light of a row.
template <class F>
GLOAM_HD float chance_of(const SceneView& scene, const paths::State<F>& path, uint32_t row,
                         bool every, uint32_t samples, int i) {
  return every ? 1.0f : static_cast<float>(samples) * path.light_sampler.probability(scene, row, i);
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
          [&] { return chance_of(scene, path, i, false, kSampledLights, at); }, clear);
    });
    set_lane(&sum, at, light);
  });
  return sum;
}

}  // namespace fasts
}  // namespace gloam
