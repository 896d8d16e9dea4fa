#pragma once
// Many lights: which to take at a surface, and the radiance of what a ray meets. The luminous
// spheres of lamps and the disc of a sun are seen in reflections, do not block rays, and are not
// shown to the camera. Device-safe.

#include "render/kernel/light.h"
#include "render/kernel/light_tree.h"

namespace gloam {

/// Scenes with more lights select by a tree.
inline constexpr uint32_t kMaxWeighedLights = 16;

/// A bound, up to a factor, of what light i brings to the surface at p with the geometric normal n
/// if nothing is in between; zero only if it brings nothing. Light from behind counts where the
/// surface lets it through.
template <class F>
GLOAM_HD F light_weight(const LightView& light, Vec3Of<F> p, Vec3Of<F> n,
                        MaskOf<F> both_sides = false) {
  if (light.kind == LightKind::kDirectional) {
    F cosine = -dot(in_all_lanes<F>(light.direction), n);
    cosine = select(both_sides, magnitude(cosine), cosine);
    return select(cosine > -light.radius, light.strength * (max(cosine, 0.0f) + 0.05f), F(0.0f));
  }
  const Vec3Of<F> to = in_all_lanes<F>(light.p) - p;
  const F above = dot(to, n);
  const F height = select(both_sides, magnitude(above), above) + light.reach;
  const F distance2 = dot(to, to);
  const F inv_d2 = 1.0f / max(max(distance2, light.reach * light.reach), 1e-8f);
  const F cosine = min(height * square_root(inv_d2), 1.0f);
  // Outside the cone of a spot nothing arrives.
  const F cone = light.kind == LightKind::kSpot
                     ? spot_falloff(light, -to / square_root(max(distance2, 1e-12f)))
                     : F(1.0f);
  return select(height > 0.0f, light.strength * inv_d2 * (cosine + 0.05f) * cone, F(0.0f));
}

/// How lights are taken at one surface: in proportion to light_weight where there are few, by a
/// tree where there are many.
template <class F>
class LightPickerOf {
 public:
  using Mask = MaskOf<F>;
  using Uint = UintOf<F>;

  /// For the surfaces at p with the geometric normals n, in the `active` lanes; the others keep
  /// what they were prepared for. `both_sides`: those that let light through.
  GLOAM_HD void prepare(const SceneView& scene, Vec3Of<F> p, Vec3Of<F> n, Mask active = true,
                        Mask both_sides = false) {
    count_ = scene.lights.size;
    if (count_ > kMaxWeighedLights) {
      p_ = select<F>(active, p, p_);
      n_ = select<F>(active, select<F>(both_sides, Vec3Of<F>{}, n), n_);
      return;
    }
    Uint first{};  // of the guide's visibilities
    Mask guided = false;
    sky_strength_ = select(active & both_sides, F(0.0f), sky_strength_);
    if (scene.guide.nx > 0) find_rows(scene.guide, p, n, active & !both_sides, &first, &guided);
    F weight[kMaxWeighedLights], total = 0.0f, sky = 0.0f;
    for (uint32_t i = 0; i < count_; ++i) {
      const LightView& light = scene.lights[i];
      weight[i] = light_weight(light, p, n, both_sides);
      if (light.guide >= 0 && any(guided)) {
        const F visible = gather(scene.guide.visible.data + light.guide, first);
        weight[i] *= select(guided, visible, F(1.0f));
      }
      total += weight[i];
    }
    if (any(sky_strength_ > 0.0f)) {
      const F reach = square_root(min(2.0f * sky_one_minus_cos_, 1.0f));
      const F cosine = dot(sky_axis_, n) + reach;
      sky = select(cosine > 0.0f, sky_strength_ * (min(cosine, 1.0f) + 0.05f), F(0.0f));
      total += sky;
    }
    const F inverse = select(total > 0.0f, 1.0f / total, F(0.0f));
    for (uint32_t i = 0; i < count_; ++i) {
      share_[i] = select(active, weight[i] * inverse, share_[i]);
    }
    sky_share_ = select(active, sky * inverse, sky_share_);
  }

  /// Density with which sample() makes the direction d for its sky.
  GLOAM_HD F sky_pdf(Vec3Of<F> d) const {
    if (!any(sky_share_ > 0.0f)) return 0.0f;
    const Mask inside = (sky_share_ > 0.0f) & (dot(d, sky_axis_) >= 1.0f - sky_one_minus_cos_);
    return select(inside, sky_share_ * cone_pdf(sky_one_minus_cos_), F(0.0f));
  }

  /// Probabilities of taking light i where there are few.
  GLOAM_HD F shares(uint32_t i) const { return share_[i]; }
  /// Probability of taking light i in the lane `at`.
  GLOAM_HD float probability(const SceneView& scene, uint32_t i, int at) const {
    if (count_ <= kMaxWeighedLights) return lane(share_[i], at);
    return light_tree::probability(scene.light_tree, i, lane(p_, at), lane(n_, at));
  }

  /// Takes a light, or the sky, and a direction from p towards it, for the `active` lanes.
  /// `spread`: of the sky's cone.
  GLOAM_HD LightSampleOf<F> sample(const SceneView& scene, Vec3Of<F> p, F pick, Vec2Of<F> u, F time,
                                   F spread, Mask active = true) const {
    LightSampleOf<F> out;
    Mask open = active;
    if (any(sky_share_ > 0.0f)) {
      const Mask sky = active & (pick < sky_share_);
      if (any(sky)) out = select(sky, sample_sky(scene, u, spread), out);
      open = active & !sky;
      pick -= sky_share_;
    }
    if (count_ > kMaxWeighedLights) {
      each_lane(open, [&](int i) {
        set_lane(&out, i,
                 sample_by_tree(scene, lane(p, i), lane(n_, i), lane(pick, i), lane(u, i),
                                lane(time, i)));
      });
      return out;
    }
    F before = 0.0f, taken = 0.0f;
    Uint index{};
    Mask searching = open;
    for (uint32_t i = 0; i < count_; ++i) {
      const Mask can = searching & (share_[i] > 0.0f);
      before = select(can, before + taken, before);
      taken = select(can, share_[i], taken);
      index = select(can, Uint(i), index);
      searching = searching & !(can & (pick < before + taken));
    }
    open = open & (taken > 0.0f);
    pick = clamp((pick - before) / taken, 0.0f, 0.9999999f);
    for (uint32_t i = 0; i < count_; ++i) {
      const Mask mine = open & (index == i);
      if (!any(mine)) continue;
      LightSampleOf<F> s = sample_one_light(scene, i, p, pick, u, time, mine);
      s.pdf *= taken;
      out = select(mine, s, out);
    }
    return out;
  }

 private:
  /// First visibilities of the guide's rows for the surfaces, and the sky there.
  GLOAM_HD void find_rows(const LightGuide& guide, Vec3Of<F> p, Vec3Of<F> n, Mask active,
                          Uint* first, Mask* guided) {
    each_lane(active, [&](int i) {
      const int row = guide.row_at(lane(p, i), lane(n, i));
      set_lane(&sky_strength_, i, 0.0f);
      if (row < 0) return;
      set_lane(guided, i, true);
      set_lane(first, i, static_cast<uint32_t>(row) * guide.lights);
      const SkyCone& sky = guide.sky[static_cast<uint32_t>(row)];
      set_lane(&sky_strength_, i, sky.strength);
      set_lane(&sky_one_minus_cos_, i, sky.one_minus_cos);
      set_lane(&sky_axis_, i, sky.axis);
    });
  }
  GLOAM_HD static LightSample sample_by_tree(const SceneView& scene, Vec3f p, Vec3f n, float pick,
                                             Vec2f u, float time) {
    const LightChoice choice =
        light_tree::choose(scene.light_tree, p, n, light_tree::lengthen(pick, u));
    if (!(choice.probability > 0)) return {};
    LightSample s = sample_one_light(scene, choice.light, p, choice.rest, u, time);
    s.pdf *= choice.probability;
    return s;
  }
  GLOAM_HD LightSampleOf<F> sample_sky(const SceneView& scene, Vec2Of<F> u, F spread) const {
    LightSampleOf<F> s;
    s.wi = FrameOf<F>::from_z(sky_axis_).to_world(sample_cone(sky_one_minus_cos_, u));
    s.distance = 1e7f;
    s.radiance = sky_radiance_of(scene, s.wi, spread) + in_all_lanes<F>(scene.sky_ambient);
    s.pdf = sky_pdf(s.wi);
    return s;
  }

  uint32_t count_ = 0;
  F share_[kMaxWeighedLights];
  Vec3Of<F> p_, n_;  ///< of the surface where there are many lights; n_ = 0: takes from all sides
  Vec3Of<F> sky_axis_;
  F sky_one_minus_cos_{}, sky_strength_{};
  F sky_share_{};
};
using LightPicker = LightPickerOf<float>;

/// Light i of lamps and suns, as in visible_lights. `probability`: of taking it at `from`.
template <class F, class Probability>
GLOAM_HD Vec3Of<F> visible_light(const SceneView& scene, uint32_t i, const RayOf<F>& ray, F tmax,
                                 Vec3Of<F> from, F pdf_bsdf, const Probability& probability) {
  const LightView& light = scene.lights[i];
  if (light.is_delta || !light.casts_shadow || light.kind == LightKind::kInstance) return {};
  const float r2 = light.radius * light.radius;
  Vec3Of<F> radiance;
  F sin2 = r2;
  MaskOf<F> seen;
  if (light.kind == LightKind::kDirectional) {
    seen = (tmax >= 1e29f) &
           (-dot(ray.d, in_all_lanes<F>(light.direction)) >= 1.0f - one_minus_cos_of(r2));
    if (!any(seen)) return {};
    radiance = in_all_lanes<F>(light.intensity / (kPi * r2));
  } else {
    const F t = enter_sphere(ray, light.p, light.radius);
    const Vec3Of<F> to = in_all_lanes<F>(light.p) - from;
    const F d2 = dot(to, to);
    seen = (t > 0.0f) & (t < tmax) & (d2 > r2 * 1.0001f);
    if (!any(seen)) return {};
    radiance = in_all_lanes<F>(light.intensity) *
               (spot_falloff(light, -to / square_root(d2)) / (kPi * r2));
    sin2 = min(r2 / d2, 1.0f);
  }
  const F pdf = probability() * cone_pdf(one_minus_cos_of(sin2));
  return select<F>(seen, radiance * mis_weight(pdf_bsdf, pdf), Vec3Of<F>{});
}

/// Light of lamps and suns that the scattered rays of the `active` lanes meet before `tmax`, each
/// weighted against `picker` at `from`, the surface that scattered it, by the density `pdf_bsdf` of
/// its direction.
template <class F>
GLOAM_HD Vec3Of<F> visible_lights(const SceneView& scene, const RayOf<F>& ray, F tmax,
                                  Vec3Of<F> from, const LightPickerOf<F>& picker, F pdf_bsdf,
                                  MaskOf<F> active) {
  Vec3Of<F> sum;
  if (scene.lights.size <= kMaxWeighedLights) {
    for (uint32_t i = 0; i < scene.lights.size; ++i) {
      sum += visible_light(scene, i, ray, tmax, from, pdf_bsdf, [&] { return picker.shares(i); });
    }
    return sum;
  }
  each_lane(active, [&](int at) {
    const Ray one = lane(ray, at);
    const float most = lane(tmax, at);
    Vec3f light;
    light_tree::each_shown(scene.light_tree, one, most, [&](uint32_t i) {
      light += visible_light<float>(scene, i, one, most, lane(from, at), lane(pdf_bsdf, at),
                                    [&] { return picker.probability(scene, i, at); });
    });
    set_lane(&sum, at, light);
  });
  return sum;
}

}  // namespace gloam
