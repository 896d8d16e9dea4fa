#pragma once
// Media that glow, as light for a point, by lines through them: Simon et al. 2017, "Line
// integration for rendering heterogeneous emissive volumes". The inside of a thick flame gives no
// light, so samples of points there would be noise. Device-safe.

#include "render/kernel/light/glow.h"
#include "render/kernel/media/medium_walk.h"

namespace gloam::glow {

/// Distance within which glowing media are not sampled as a lamp [m]: few of their points would
/// bring nearly all light.
inline constexpr float kNearGlow = 0.1f;

/// Distance, in reaches of the glowing medium, within which its nearest part is the brightest: a
/// point is chosen among kGlowCandidates there (Talbot et al. 2005, "Importance resampling for
/// global illumination").
inline constexpr float kNearGlowReach = 2;
inline constexpr int kGlowCandidates = 2;

/// A line from p through a medium that glows.
struct LineSample {
  LightSample light;  ///< radiance over pdf: as it leaves what glows towards p
  float clear = 0;    ///< distance at which that begins [m]: what is before it dims
};

/// Extinction by all volumes but one [1/m].
GLOAM_HD Vec3f extinction_beside(const MediaView& media, uint32_t but, Vec3f p) {
  Vec3f sum;
  for (uint32_t i = 0; i < media.volumes.size; ++i) {
    const VolumeView& v = media.volumes[i];
    const Vec3f p_G = transform_point(v.X_GW, p);
    if (i == but || !media::is_inside(v, p_G)) continue;
    sum += Bands{}.of(v.mass_extinction) * media::density_at(v, p_G);
  }
  return sum;
}

/// A line is sampled with a point of it, as by sample(), and so are the places on it at which light
/// is summed up, a step apart: of these any might have been the point, and the line's density is
/// that of all. Beyond kNearGlow.
GLOAM_HD LineSample sample_line(const MediaView& media, Vec3f p, Vec3f n, Vec2f u) {
  constexpr float kVoxels = 1.5f;  // a step: small flames are but few voxels wide
  constexpr float kMostSteps = 16;
  LineSample out;
  const Choice choice = choose(media, p, n, &u);
  if (!(choice.probability > 0)) return out;
  const GlowView& glow = *choice.glow;
  const VolumeView& v = media.volumes[glow.volume];
  LightSample& light = out.light;
  const bool beside = length_squared(glow.center - p) < sqr(kNearGlowReach * glow.reach);
  const auto weight_of = [&](Vec3f to) {
    return beside ? point_weight(to, 0, kNearGlow, n) : 1.0f;
  };
  const int draws = beside ? kGlowCandidates : 1;
  WalkRandom random({u.y, u.x});
  Vec3f to;
  float weights = 0;
  for (int i = 0; i < draws; ++i) {
    const PointSample point = sample_point(v, glow, u);
    u = {u.x + 1.0f / kGlowCandidates, random.next()};
    if (u.x >= 1) u.x -= 1;
    if (!(point.density > 0)) continue;
    const Vec3f there = transform_point(glow.X_WG, point.p_G) - p;
    const float its = weight_of(there);
    weights += its;
    if (i == 0 || random.next() * weights < its) to = there;
  }
  light.distance = length(to);
  if (!(weights > 0 && light.distance > 1e-6f)) return out;
  light.wi = to / light.distance;
  const Vec3f o_G = transform_point(v.X_GW, p), d_G = transform_vector(v.X_GW, light.wi);
  float from = 0, end = 1e30f;
  clip_to_box(o_G, d_G, glow.low_G, glow.high_G, &from, &end);
  from = min(from, light.distance), end = max(end, light.distance);  // for rounding
  const float voxel = min(v.voxel.x, min(v.voxel.y, v.voxel.z));
  const float step = max(kVoxels * voxel, (end - from) * (1 / kMostSteps));
  const Vec3f k = Bands{}.of(v.mass_extinction), absorbed = Vec3f{1, 1, 1} - Bands{}.of(v.albedo);
  Vec3f through{1, 1, 1}, radiance;
  float pdf = 0, t = light.distance - floorf((light.distance - from) / step) * step;
  out.clear = max(t - 0.5f * step, 0.0f);
  for (; t <= end; t += step) {
    const Vec3f p_G = o_G + d_G * t;
    if (!media::is_inside(v, p_G)) continue;
    const Vec3f extinction = k * media::density_at(v, p_G);
    const Vec3f dims = extinction + extinction_beside(media, glow.volume, p + light.wi * t);
    const Vec3f half = media::exp_of(dims * (-0.5f * step));
    if (t > kNearGlow) {
      radiance += through * half * extinction * absorbed * media::glow_at(media, v, p_G, {});
    }
    through *= half * half;
    pdf += point_density(media, glow, p_G) * sqr(t) * weight_of(light.wi * t);
  }
  light.radiance = radiance;
  light.pdf = pdf * choice.probability * (static_cast<float>(draws) / weights);
  if (!(max_component(radiance) > 0)) light.pdf = 0;
  return out;
}

}  // namespace gloam::glow
