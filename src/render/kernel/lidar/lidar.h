#pragma once
// Signal of a LiDAR's pulse from the surfaces that it meets, relative to that of a white Lambertian
// plate across the beam, 1 m away: of a surface at range R it is
//   G T² O(R) / R²,  G = pi f(w, w) cos
// with the BSDF f back along the beam, the two-way transmittance T² of what lies before it and the
// overlap O of beam and receiver (kernel/lidar/lidar_particles.h; the LiDAR equation, e.g. Wehr and
// Lohr 1999, "Airborne laser scanning - an introduction and overview"). Device-safe.

#include "render/kernel/lidar/lidar_detect.h"
#include "render/kernel/lidar/lidar_media.h"
#include "render/kernel/lidar/lidar_motion.h"
#include "render/kernel/path/path_state.h"
#include "render/kernel/surface/surface.h"

namespace gloam {

/// The beam turned to point p of its footprint: p in half angles, x to the left and y up across d.
template <class F>
GLOAM_HD Vec3Of<F> footprint_direction(const LidarOptics& optics, Vec3Of<F> d_L, Vec2f p) {
  const MaskOf<F> upright = magnitude(d_L.z) > 0.9999f;
  const Vec3Of<F> flat =
      select<F>(upright, Vec3Of<F>{F(0.0f), F(1.0f), F(0.0f)}, Vec3Of<F>{-d_L.y, d_L.x, F(0.0f)});
  const Vec3Of<F> left = normalize(flat), up = cross(d_L, left);
  return normalize(d_L + left * F(0.5f * optics.divergence.x * p.x) +
                   up * F(0.5f * optics.divergence.y * p.y));
}

namespace lidar {

/// Surfaces that one ray may meet.
inline constexpr int kMostSurfaces = 8;
/// Two-way fraction of the pulse below which it is not followed.
inline constexpr float kMinTwoWayTransmission = 1e-4f;

/// Half the mean divergence [rad], as a GGX width. The spot that a flat mirror throws back at the
/// receiver is as wide as the beam has become: seen from there, the mirror is as rough as this.
GLOAM_HD float blur_of(const LidarOptics& optics) {
  return max(0.25f * (optics.divergence.x + optics.divergence.y), 1e-3f);
}

/// A roughness with its lobe widened by the beam.
template <class F>
GLOAM_HD F blurred(F roughness, float blur) {
  const F r2 = roughness * roughness;
  return square_root(square_root(r2 * r2 + F(blur * blur)));
}

/// G of a surface. Of the bands that a colour knows, red is the nearest to a LiDAR's. What
/// retroreflectors send back (CIE 54.2:2001) is taken to fall with the cosine of incidence.
template <class F>
GLOAM_HD F reflectivity(const SceneView& scene, const LidarOptics& optics, Vec3Of<F> back,
                        float blur, MaskOf<F> found, SurfaceOf<F>* s, LayeredBsdfOf<F>* bsdf,
                        FrameOf<F>* frame) {
  F retro{};
  if (!optics.surfaces.empty()) {
    each_lane(found, [&](int i) {
      const LidarSurface& own = optics.surfaces[lane(s->instance, i)];
      Vec3f color = lane(s->base_color, i);
      color.x = min(color.x * own.diffuse, 1.0f);
      set_lane(&s->base_color, i, color);
      set_lane(&retro, i, own.retro);
    });
  }
  s->roughness = blurred(s->roughness, blur);
  s->coat_roughness = blurred(s->coat_roughness, blur);
  *bsdf = surface_bsdf(scene, *s, back, frame, found);
  Vec3Of<F> w = frame->to_local(back);
  w.z = max(w.z, 1e-4f);
  F pdf;
  return (eval_bsdf(*bsdf, w, w, &pdf).x + retro * w.z) * kPi * s->opacity;
}

/// Absorption of glass at the sensor's wavelength, where it is known, instead of that of the
/// visible bands, in the lanes that have crossed the surfaces `s`.
template <class F>
GLOAM_HD Vec3Of<F> own_absorption(const LidarOptics& optics, const SurfaceOf<F>& s,
                                  MaskOf<F> crossing, Vec3Of<F> beyond) {
  if (optics.surfaces.empty()) return beyond;
  each_lane(crossing & s.outside, [&](int i) {
    const float own = optics.surfaces[lane(s.instance, i)].absorption;
    if (own >= 0) set_lane(&beyond, i, {own, own, own});
  });
  return beyond;
}

/// Parts of a BSDF that pass_glass() reads, in lane i.
template <class F>
GLOAM_HD LayeredBsdf glass_of(const LayeredBsdfOf<F>& b, int i) {
  LayeredBsdf one;
  one.thin = lane(b.thin, i);
  one.eta = lane(b.eta, i);
  one.tint = lane(b.tint, i);
  one.under = lane(b.under, i);
  one.glass = lane(b.glass, i);
  return one;
}

/// One-way fraction of a pulse that a surface of glass passes on in the direction *d, which it
/// bends. Rough glass scatters the rest out of the beam. `roughness`: without blur.
GLOAM_HD float pass_glass(const LayeredBsdf& b, const Frame& frame, float roughness, float blur,
                          Vec3f* d) {
  Vec3f wo = frame.to_local(-*d);
  wo.z = max(wo.z, 1e-4f);
  float cos_t;
  const float reflects = layers::glass_reflects(b, wo.z, &cos_t);
  if (!b.thin) {
    const Vec3f bent = refract(wo, Vec3f{0, 0, 1}, b.eta, wo.z, cos_t);
    if (!(bent.z < 0)) return 0;
    *d = normalize(frame.to_world(bent));
  }
  const float r2 = roughness * roughness, straight = blur * blur / (r2 * r2 + blur * blur);
  return max(1.0f - reflects, 0.0f) * b.tint.x * b.under.x * min(b.glass, 1.0f) * straight;
}

}  // namespace lidar

/// Follows the rays of the `active` lanes, which start at a sensor and carry `pulse` each, and adds
/// what comes back from surfaces to `echoes[lane]`. A pulse passes what lets it through: sheets,
/// holes, glass, which bends it and makes its way longer. `soft[lane]` takes what comes back from
/// media; null = that is not asked, though they dim all the same.
template <class F, class Tracer>
GLOAM_HD void trace_echoes(const SceneView& scene, const Tracer& tracer, const LidarOptics& optics,
                           RayOf<F> ray, MaskOf<F> active, float pulse, LidarEchoes* echoes,
                           Backscatter* soft) {
  const float blur = lidar::blur_of(optics);
  const bool has_media = !scene.media.volumes.empty();
  F way = F(optics.min_range);  // to the ray's origin [m]
  F fraction = F(1.0f);         // of the pulse that arrives there
  F index = F(1.0f);            // of refraction
  Vec3Of<F> absorption;
  const auto dim = [&](F length, F from, Backscatter* back) {
    each_lane(active, [&](int i) {
      const float before = lane(fraction, i);
      set_lane(&fraction, i,
               before * cross_media(scene.media, optics, lane(ray, i), lane(length, i),
                                    lane(from, i), before, back == nullptr ? nullptr : &back[i]));
    });
  };
  if (has_media) dim(way, F(0.0f), nullptr);
  ray.o += ray.d * way;
  ray.tmax = F(optics.max_range - optics.min_range);
  const RayConeOf<F> cone{F(0.0f), F(0.5f * (optics.divergence.x + optics.divergence.y))};
  for (int n = 0; n < lidar::kMostSurfaces && any(active); ++n) {
    RayHitOf<F> hit;
    const MaskOf<F> found = tracer.closest(ray, active, n == 0, &hit);
    if (has_media) dim(select(found, hit.t, ray.tmax), way, soft);
    active = found;
    if (!any(active)) return;
    if (n > 0) fraction *= paths::through_glass(absorption, hit.t).x;

    SurfaceOf<F> s = make_surface(scene, ray, hit, cone, active);
    const F roughness = s.roughness;
    LayeredBsdfOf<F> bsdf;
    FrameOf<F> frame;
    const F g = lidar::reflectivity(scene, optics, -ray.d, blur, active, &s, &bsdf, &frame);
    way += hit.t * index;
    MaskOf<F> unseen = color_only_lanes<F>(scene, s.instance, active);
    if (!optics.hidden.empty()) {
      each_lane(active, [&](int i) {
        if (optics.hidden[lane(s.instance, i)] != 0) set_lane(&unseen, i, true);
      });
    }
    const F signal = select(unseen, F(0.0f), g * fraction * fraction * pulse / (way * way));
    each_lane(active & (signal > 0.0f), [&](int i) {
      const float range = lane(way, i), seen = lane(signal, i) * lidar::overlap(optics, range);
      if (seen > 0) echoes[i].add({range, seen, lane(s.instance, i) + 1});
    });

    if (!scene.has_transparent && scene.layers.empty() && !any(unseen)) return;
    F passed = select(unseen, F(1.0f), passing_light(s).x);
    Vec3Of<F> d = ray.d;
    each_lane(active & bsdf.layered & (bsdf.p_glass > 0.0f) & !bsdf.straight & !unseen, [&](int i) {
      Vec3f bent = lane(d, i);
      const Frame axes{lane(frame.x, i), lane(frame.y, i), lane(frame.z, i)};
      const float through =
          lidar::pass_glass(lidar::glass_of(bsdf, i), axes, lane(roughness, i), blur, &bent);
      set_lane(&passed, i, lane(passed, i) + through * lane(s.opacity, i));
      if (!(through > 0)) return;
      set_lane(&d, i, bent);
      if (!lane(bsdf.thin, i)) {
        set_lane(&index, i, max(lane(index, i) * lane(bsdf.eta, i), 1.0f));
      }
    });
    fraction *= passed;
    active = active & (fraction * fraction > lidar::kMinTwoWayTransmission);
    if (!any(active)) return;
    const MaskOf<F> crossing = active & !unseen & (dot(d, s.geometric) < 0.0f);
    absorption = paths::absorption_beyond(scene, s, crossing, absorption);
    absorption = lidar::own_absorption(optics, s, crossing, absorption);
    ray.o = select<F>(active, leave_surface(s.p, s.geometric, d, hit.t), ray.o);
    ray.d = select<F>(active, d, ray.d);
    ray.tmax = F(optics.max_range) - way;
    active = active & (ray.tmax > 0.0f);
  }
}

}  // namespace gloam
