#pragma once
// Sampling of one of many lights at a surface, and the radiance of lamps and suns that a ray meets.
// The luminous spheres of lamps and the disc of a sun are seen in reflections, do not block rays,
// and are not shown to the camera. Device-safe.

#include "render/kernel/light/glow.h"
#include "render/kernel/light/light_tree.h"
#include "render/kernel/light/sky.h"

namespace gloam {

/// Bound, up to a factor, of the light's illuminance at the surface at p with the geometric normal
/// n if nothing is in between; zero only if it brings nothing. Light from behind counts where the
/// surface lets it through; points in a medium (n = 0) take it from all around.
template <class F>
GLOAM_HD F light_weight(const SceneView& scene, const LightView& light, Vec3Of<F> p, Vec3Of<F> n,
                        MaskOf<F> both_sides = false) {
  const MaskOf<F> floats = !(length_squared(n) > 0.0f);
  const bool turns = !kPlainScenes && light.first_key >= 0;
  if (light.kind == LightKind::kDirectional) {
    if (turns) return light.strength;
    F cosine = -dot(in_all_lanes<F>(light.direction), n);
    cosine = select(floats, F(1.0f), select(both_sides, magnitude(cosine), cosine));
    return select(cosine > -light.radius, light.strength * (max(cosine, 0.0f) + 0.05f), F(0.0f));
  }
  const Vec3Of<F> to = in_all_lanes<F>(light.p) - p;
  const F distance2 = dot(to, to), above = dot(to, n);
  const F height =
      select(floats, square_root(distance2), select(both_sides, magnitude(above), above)) +
      light.reach;
  const F inv_d2 = 1.0f / max(max(distance2, light.reach * light.reach), 1e-8f);
  const F cosine = min(height * square_root(inv_d2), 1.0f);
  F weight = select(height > 0.0f, light.strength * inv_d2 * (cosine + 0.05f), F(0.0f));
  // Outside the cone of a spot nothing arrives.
  if (!turns && (light.kind == LightKind::kSpot || light.profile >= 0)) {
    weight *= relative_intensity(scene, light, -to / square_root(max(distance2, 1e-12f)));
  }
  return weight;
}

/// Rows of the scene's guide, in the `guided` lanes.
template <class F>
struct GuideRowsOf {
  UintOf<F> row{};
  MaskOf<F> guided = false;
};

/// Rows for the points p on surfaces with the geometric normals n, in the `active` lanes.
template <class F>
GLOAM_HD GuideRowsOf<F> find_rows(const LightGuide& guide, Vec3Of<F> p, Vec3Of<F> n,
                                  MaskOf<F> active) {
  const UintOf<F> row = guide.row_at(p, n);
  GuideRowsOf<F> rows;
  rows.guided = active & (row != LightGuide::kNone);
  rows.row = select(rows.guided, row, UintOf<F>(0u));
  return rows;
}

/// Scratch for the probabilities of lights, one each.
template <class F>
struct LightProbabilitiesOf {
  F of[kMaxWeighedLights];
};

/// Light sampler of one surface: in proportion to light_weight where lights are few, by a tree
/// where there are many.
template <class F>
class LightSamplerOf {
 public:
  using Mask = MaskOf<F>;
  using Uint = UintOf<F>;

  /// On a card the probabilities lie apart: what is indexed at run time lies in memory, and would
  /// draw all of a path's state there with it. To be called there before all else.
#ifdef __CUDACC__
  GLOAM_HD void keep_in(LightProbabilitiesOf<F>* scratch) { probability_ = scratch->of; }
#else
  void keep_in(LightProbabilitiesOf<F>*) {}
#endif

  /// Prepares for the surfaces at p with the geometric normals n, or points in a medium (n = 0), in
  /// the `active` lanes; the others keep what they were prepared for. `both_sides`: lanes whose
  /// surface lets light through. Returns the rows of the scene's guide there.
  GLOAM_HD GuideRowsOf<F> prepare(const SceneView& scene, Vec3Of<F> p, Vec3Of<F> n,
                                  Mask active = true, Mask both_sides = false) {
    count_ = scene.lights.size;
    p_ = select<F>(active, p, p_);
    n_ = select<F>(active, select<F>(both_sides, Vec3Of<F>{}, n), n_);
    GuideRowsOf<F> rows;
    if (scene.guide.nx > 0) rows = find_rows(scene.guide, p, n, active & !both_sides);
    const bool weighs = !scene.has_many_lights();
    F weight[kMaxWeighedLights], total = 0.0f;
    for (uint32_t i = 0; weighs && i < count_; ++i) {
      const LightView& light = scene.lights[i];
      weight[i] = light_weight(scene, light, p, n, both_sides);
      if (light.guide >= 0 && scene.guide.lights > 0 && any(rows.guided)) {
        const F gain =
            gather(scene.guide.gain.data + light.guide, rows.row * Uint(scene.guide.lights));
        weight[i] *= select(rows.guided, gain, F(1.0f));
      }
      total += weight[i];
    }
    F sky = 0.0f, visible = 1.0f;
    if (scene.has_environment() && !scene.environment.row_cdf.empty()) {
      sky = 0.25f * scene.environment.illuminance;  // of even light from all around
      if (any(rows.guided)) {
        // Directions through windows are the guide's: it knows them better than the whole map.
        visible = select(rows.guided, gather(scene.guide.sky_visible.data, rows.row), F(1.0f));
        sky *= weighs ? visible * visible : visible;
      }
    }
    // Lights that are not weighed get half, and what the sky loses behind walls.
    total = weighs ? total + sky : F(0.5f * scene.environment.illuminance);
    const F inverse = select(total > 0.0f, 1.0f / total, F(0.0f));
    for (uint32_t i = 0; weighs && i < count_; ++i) {
      // Written above for all of them. NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage)
      probability_[i] = select(active, weight[i] * inverse, probability_[i]);
    }
    if (scene.has_environment()) sky_probability_ = select(active, sky * inverse, sky_probability_);
    if (scene.has_glow()) total_ = select(active, weighs ? total : F(-1.0f), total_);
    return rows;
  }

  /// Adds, after prepare(), media that glow to the choice; `beside_many`: their probability where
  /// lights are not weighed, and at most beside more than kMaxLightsWithoutTree.
  GLOAM_HD void add_glow(const SceneView& scene, Mask active, float beside_many = 0.5f) {
    each_lane(active, [&](int i) {
      const float glow = glow::weight(scene.media.glows, lane(p_, i), lane(n_, i));
      const float total = lane(total_, i);
      float probability = total < 0 ? beside_many : glow / (glow + total);
      // Walls hide a fire, too: in other rooms of a house its lamps need their samples.
      if (scene.lights.size > kMaxLightsWithoutTree) probability = min(probability, beside_many);
      set_lane(&glow_probability_, i, glow > 0 ? probability : 0.0f);
    });
    const F rest = select(active, 1.0f - glow_probability_, F(1.0f));
    for (uint32_t i = 0; !scene.has_many_lights() && i < count_; ++i) probability_[i] *= rest;
    if (scene.has_environment()) sky_probability_ *= rest;
  }

  /// Probability of media, after leave_out_sky() and add_glow(): sample() takes them by u.x below
  /// this.
  GLOAM_HD F glow_probability() const { return glow_probability_; }

  /// Density per solid angle, as in glow::pdf, with which sample() finds the point p_W, p_G in the
  /// volume of scene.media.glows[row], in the lane `at`.
  GLOAM_HD float glow_pdf(const SceneView& scene, int row, int at, Vec3f p_W, Vec3f p_G) const {
    const Vec3f p = lane(p_, at), n = lane(n_, at);
    if (!(lane(glow_probability_, at) > 0)) return 0;
    const GlowView& mine = scene.media.glows[static_cast<uint32_t>(row)];
    const float total = glow::weight(scene.media.glows, p, n);
    return lane(glow_probability_, at) * glow::weight(mine, p, n) / total *
           glow::pdf(scene.media, mine, p, p_W, p_G);
  }

  /// Removes, after prepare(), the sky from the choice.
  GLOAM_HD void leave_out_sky(const SceneView& scene) {
    const F rest = 1.0f - sky_probability_, scale = select(rest > 1e-6f, 1.0f / rest, F(0.0f));
    for (uint32_t i = 0; !scene.has_many_lights() && i < count_; ++i) probability_[i] *= scale;
    sky_probability_ = 0.0f;
  }

  /// Density with which sample() makes the direction d for its sky, in the `active` lanes.
  GLOAM_HD F sky_pdf(const SceneView& scene, Vec3Of<F> d, Mask active) const {
    F pdf = 0.0f;
    each_lane(active & (sky_probability_ > 0.0f) & scene.has_environment(), [&](int i) {
      set_lane(&pdf, i, lane(sky_probability_, i) * environment_pdf(scene.environment, lane(d, i)));
    });
    return pdf;
  }

  /// Probabilities of taking light i where there are few.
  GLOAM_HD F probabilities(uint32_t i) const { return probability_[i]; }
  /// Probability of taking light i in the lane `at`.
  GLOAM_HD float probability(const SceneView& scene, uint32_t i, int at) const {
    if (!scene.has_many_lights()) return lane(probability_[i], at);
    return lane(lights_probability(scene), at) *
           light_tree::probability(scene.light_tree, i, lane(p_, at), lane(n_, at));
  }

  /// Sample of a light, or of the sky: which by u.x, and a direction from p towards it by what is
  /// left of u.x and by u.y, for the `active` lanes. Points u that are spread evenly are so over
  /// each light.
  GLOAM_HD_LARGE LightSampleOf<F> sample(const SceneView& scene, Vec3Of<F> p, Vec2Of<F> u, F time,
                                         Mask active = true) const {
    LightSampleOf<F> out;
    Mask open = active;
    if (scene.has_environment()) {
      const Mask sky = active & (u.x < sky_probability_);
      each_lane(sky, [&](int i) {
        const Vec2f at = lane(u, i);
        const float x = rest_of(at.x, 0.0f, lane(sky_probability_, i));
        set_lane(&out, i, sample_sky(scene, {x, at.y}, i));
      });
      open = active & !sky;
    }
    F before = sky_probability_;
    if (scene.has_glow()) {
      const Mask glowing = open & (u.x < before + glow_probability_);
      each_lane(glowing, [&](int i) {
        const Vec2f at = lane(u, i);
        const float x = rest_of(at.x, lane(before, i), lane(glow_probability_, i));
        set_lane(&out, i, sample_glow(scene, i, {x, at.y}));
      });
      open = open & !glowing;
      before += glow_probability_;
    }
    if (scene.has_many_lights()) {
      const F of_lights = lights_probability(scene);
      u.x = rest_of(u.x, before, of_lights);
      each_lane(open, [&](int i) {
        set_lane(&out, i,
                 sample_by_tree(scene, lane(p, i), lane(n_, i), lane(u, i), lane(time, i)));
      });
      out.pdf = select(open, out.pdf * of_lights, out.pdf);
      return out;
    }
    F taken = 0.0f;
    Uint index{};
    Mask searching = open;
    for (uint32_t i = 0; i < count_; ++i) {
      const Mask can = searching & (probability_[i] > 0.0f);
      before = select(can, before + taken, before);
      taken = select(can, probability_[i], taken);
      index = select(can, Uint(i), index);
      searching = searching & !(can & (u.x < before + taken));
    }
    open = open & (taken > 0.0f);
    u.x = rest_of(u.x, before, taken);
    if constexpr (Lanes<F>::kCount == 1) {
      if (!open) return out;
      out = sample_one_light(scene, index, p, u, time);
      out.pdf *= taken;
      return out;
    }
    const Mask balls = sample_balls(scene, p, u, open, index, &out);
    out.pdf = select(balls, out.pdf * taken, out.pdf);
    open = open & !balls;
    for (uint32_t i = 0; any(open) && i < count_; ++i) {
      const Mask mine = open & (index == i);
      if (!any(mine)) continue;
      LightSampleOf<F> s = sample_one_light(scene, i, p, u, time, mine);
      s.pdf *= taken;
      out = select(mine, s, out);
    }
    return out;
  }

 private:
  /// Probability of the lights: the rest of that of the sky and of media.
  GLOAM_HD F lights_probability(const SceneView& scene) const {
    return scene.has_glow() ? 1.0f - sky_probability_ - glow_probability_ : 1.0f - sky_probability_;
  }
  GLOAM_HD static LightSample sample_by_tree(const SceneView& scene, Vec3f p, Vec3f n, Vec2f u,
                                             float time) {
    const LightChoice choice = light_tree::choose(scene.light_tree, p, n, light_tree::lengthen(u));
    if (!(choice.probability > 0)) return {};
    LightSample s = sample_one_light(scene, choice.light, p, {choice.rest, u.y}, time);
    s.pdf *= choice.probability;
    return s;
  }
  /// Samples towards those lights `index` of the `active` lanes that are balls around none of the
  /// points p, all at once; returns their lanes.
  GLOAM_HD static Mask sample_balls(const SceneView& scene, Vec3Of<F> p, Vec2Of<F> u, Mask active,
                                    Uint index, LightSampleOf<F>* out) {
    Mask balls = false;
    Vec3Of<F> center, radiance;
    F radius = 1.0f;
    each_lane(active, [&](int i) {
      const LightView& light = scene.lights[lane(index, i)];
      if (!light.is_ball) return;
      set_lane(&balls, i, true);
      set_lane(&center, i, light.p);
      set_lane(&radius, i, light.radius);
      set_lane(&radiance, i, light.intensity);
    });
    if (!any(balls)) return balls;
    balls = balls & lights::is_outside_ball(radius, center, p);
    Vec3Of<F> normal;
    LightSampleOf<F> s = lights::sample_ball(radius, center, p, u, &normal);
    s.radiance = radiance;
    *out = select(balls, s, *out);
    return balls;
  }
  GLOAM_HD LightSample sample_glow(const SceneView& scene, int at, Vec2f u) const {
    LightSample s = glow::sample(scene.media, lane(p_, at), lane(n_, at), u);
    s.pdf *= lane(glow_probability_, at);
    return s;
  }
  GLOAM_HD LightSample sample_sky(const SceneView& scene, Vec2f u, int at) const {
    const EnvironmentSample sky = environment_sample(scene.environment, u);
    LightSample s;
    s.wi = sky.wi;
    s.distance = 1e7f;
    s.radiance = sky.radiance + scene.sky_ambient;
    s.pdf = sky.pdf * lane(sky_probability_, at);
    return s;
  }

  uint32_t count_ = 0;
#ifdef __CUDACC__
  F* probability_ = nullptr;
#else
  F probability_[kMaxWeighedLights];
#endif
  Vec3Of<F> p_, n_;       ///< of the surface; n_ = 0: takes from all sides
  F sky_probability_{};   ///< of the environment map
  F glow_probability_{};  ///< of media that glow
  F total_{};             ///< sum of the weights that gave the probabilities; -1 = is not known
};
using LightSampler = LightSamplerOf<float>;

#if !defined(__CUDACC__) && \
    !defined(GLOAM_LARGE_IN_PLACE)  // instantiated in render/cpu/kernels/lights.cc
extern template LightSample LightSampler::sample(const SceneView&, Vec3f, Vec2f, float, bool) const;
extern template LightSampleOf<FloatLanes> LightSamplerOf<FloatLanes>::sample(
    const SceneView&, Vec3Of<FloatLanes>, Vec2Of<FloatLanes>, FloatLanes, MaskLanes) const;
#endif

/// A lamp or sun that stands still, as in visible_lights. `probability`: of taking it at `from`.
template <class F, class Probability, class Passing>
GLOAM_HD Vec3Of<F> still_light(const SceneView& scene, const LightView& light, const RayOf<F>& ray,
                               F tmax, Vec3Of<F> from, F pdf_bsdf, MaskOf<F> active,
                               const Probability& probability, const Passing& passing) {
  const float r2 = light.radius * light.radius;
  Vec3Of<F> radiance;
  F sin2 = r2, t = tmax;
  MaskOf<F> seen;
  if (light.kind == LightKind::kDirectional) {
    seen = active & (tmax >= 1e29f) &
           (-dot(ray.d, in_all_lanes<F>(light.direction)) >= 1.0f - one_minus_cos_of(r2));
    if (!any(seen)) return {};
    radiance = in_all_lanes<F>(light.intensity / (kPi * r2));
  } else {
    t = enter_sphere(ray, light.p, light.radius);
    const Vec3Of<F> to = in_all_lanes<F>(light.p) - from;
    const F d2 = dot(to, to);
    seen = active & (t > 0.0f) & (t < tmax) & (d2 > r2 * 1.0001f);
    if (!any(seen)) return {};
    radiance = in_all_lanes<F>(light.intensity) *
               (relative_intensity(scene, light, -to / square_root(d2)) / (kPi * r2));
    sin2 = min(r2 / d2, 1.0f);
  }
  if (scene.has_media()) {
    each_lane(seen, [&](int at) {
      set_lane(&radiance, at, lane(radiance, at) * passing(at, lane(t, at)));
    });
  }
  const F pdf = probability() * cone_pdf(one_minus_cos_of(sin2));
  return select<F>(seen, radiance * mis_weight(pdf_bsdf, pdf), Vec3Of<F>{});
}

/// Light i of lamps and suns, as in visible_lights. `probability`: of taking it at `from`.
template <class F, class Probability, class Passing>
GLOAM_HD Vec3Of<F> visible_light(const SceneView& scene, uint32_t i, const RayOf<F>& ray, F tmax,
                                 Vec3Of<F> from, F pdf_bsdf, MaskOf<F> active,
                                 const Probability& probability, const Passing& passing) {
  const LightView& light = scene.lights[i];
  if (light.is_delta || !light.casts_shadow || light.kind == LightKind::kInstance) return {};
  const bool flickers = scene.has_flicker() && light.levels >= 0;
  if (kPlainScenes || (light.first_key < 0 && !flickers)) {
    return still_light(scene, light, ray, tmax, from, pdf_bsdf, active, probability, passing);
  }
  Vec3Of<F> sum;
  each_lane(active, [&](int at) {
    const Ray one = lane(ray, at);
    const float chance = lane(F(probability()), at);
    const Vec3f even = still_light<float>(
        scene, light_at(scene, light, one.time), one, lane(tmax, at), lane(from, at),
        lane(pdf_bsdf, at), true, [&] { return chance; },
        [&](int, float t) { return passing(at, t); });
    set_lane(&sum, at, flickers ? even * level_at(scene, light.levels, one.time) : even);
  });
  return sum;
}

/// Light of lamps and suns that the scattered rays of the `active` lanes meet before `tmax`, each
/// weighted against `light_sampler` at `from`, the point that scattered it, by the density
/// `pdf_bsdf` of its direction. `passing(lane, t)`: transmittance of media up to there.
template <class F, class Passing>
GLOAM_HD Vec3Of<F> visible_lights(const SceneView& scene, const RayOf<F>& ray, F tmax,
                                  Vec3Of<F> from, const LightSamplerOf<F>& light_sampler,
                                  F pdf_bsdf, MaskOf<F> active, const Passing& passing) {
  Vec3Of<F> sum;
  if (!scene.has_many_lights()) {
    for (uint32_t i = 0; i < scene.lights.size; ++i) {
      sum += visible_light(
          scene, i, ray, tmax, from, pdf_bsdf, active,
          [&] { return light_sampler.probabilities(i); }, passing);
    }
    return sum;
  }
  each_lane(active, [&](int at) {
    const Ray one = lane(ray, at);
    const float most = lane(tmax, at);
    Vec3f light;
    light_tree::each_shown(scene.light_tree, one, most, [&](uint32_t i) {
      light += visible_light<float>(
          scene, i, one, most, lane(from, at), lane(pdf_bsdf, at), true,
          [&] { return light_sampler.probability(scene, i, at); },
          [&](int, float t) { return passing(at, t); });
    });
    set_lane(&sum, at, light);
  });
  return sum;
}

}  // namespace gloam
