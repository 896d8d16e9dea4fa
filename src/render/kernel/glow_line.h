#pragma once
// What glows, as light for a point, by pieces of lines: Simon et al. 2017, "Line integration for
// rendering heterogeneous emissive volumes". The inside of a thick flame gives no light, and a
// sample of one point there would be noise. Device-safe.

#include "render/kernel/glow.h"

namespace gloam::glow {

/// What glows closer by is no lamp [m]: its points are drawn without a look at their distance, so
/// that few of them would bring nearly all light.
inline constexpr float kNearGlow = 0.1f;

/// A piece of a line from p through a medium that glows.
struct LineSample {
  LightSample light;  ///< radiance over pdf: of the piece, as it leaves it towards p
  float clear = 0;    ///< distance at which the piece begins [m]: what is before it dims
};

/// A point is drawn as by sample(); it is any of the piece's kParts. Of all pieces that hold a
/// point, each draws its light over the sum of their densities (the balance heuristic). Beyond
/// kNearGlow.
GLOAM_HD LineSample sample_line(const MediaView& media, Vec3f p, Vec3f n, Vec2f u) {
  constexpr int kParts = 4;
  constexpr float kVoxels = 1.5f;  // of a part: small flames are but few voxels wide
  LineSample out;
  const Choice choice = choose(media, p, n, &u);
  if (!(choice.probability > 0)) return out;
  const GlowView& glow = *choice.glow;
  const VolumeView& v = media.volumes[glow.volume];
  LightSample& light = out.light;
  const PointSample point = sample_point(v, glow, u);
  const Vec3f to = transform_point(glow.X_WG, point.p_G) - p;
  light.distance = length(to);
  if (!(point.density > 0 && light.distance > 1e-6f)) return out;
  light.wi = to / light.distance;
  const float step = kVoxels * min(v.voxel.x, min(v.voxel.y, v.voxel.z));
  WalkRandom random({u.y, u.x});
  const float before = floorf(random.next() * kParts);  // parts before the point
  const Vec3f k = Bands{}.of(v.mass_extinction), absorbed = Vec3f{1, 1, 1} - Bands{}.of(v.albedo);
  out.clear = max(light.distance - (before + 0.5f) * step, 0.0f);
  Vec3f through{1, 1, 1}, radiance;
  float pdf = 0;
  for (int i = 0; i < kParts; ++i) {
    const float t = light.distance + (static_cast<float>(i) - before) * step;
    if (!(t > 0)) continue;
    const Vec3f p_G = transform_point(v.X_GW, p + light.wi * t);
    if (!media::is_inside(v, p_G)) continue;
    const Vec3f extinction = k * media::density_at(v, p_G);
    const Vec3f depth = extinction * step;
    const Vec3f half = media::exp_of(depth * -0.5f);
    if (t > kNearGlow) {
      radiance += through * half * extinction * absorbed * media::glow_at(media, v, p_G, {});
    }
    through *= half * half;
    pdf += point_density(media, glow, p_G) * sqr(t);
  }
  light.radiance = radiance;
  light.pdf = pdf * choice.probability;
  if (!(max_component(radiance) > 0)) light.pdf = 0;
  return out;
}

}  // namespace gloam::glow
