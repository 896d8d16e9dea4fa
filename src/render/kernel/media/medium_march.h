#pragma once
// Media without noise: what they are at a point, and marching through them. Device-safe.

#include "render/kernel/media/medium.h"

namespace gloam {

/// All media at a point together, per band.
struct MediumPoint {
  Vec3f extinction, scattering;  ///< [1/m]
  Vec3f emission;                ///< [cd/m² per m]
  Vec3f g_scattering;            ///< mean cosine of scattering times scattering [1/m]
};

namespace media {

/// `glows`: it may give off light there.
GLOAM_HD void add_volume(const MediaView& media, const VolumeView& volume, Vec3f p_W, Bands bands,
                         MediumPoint* point, bool glows = true) {
  const Vec3f p_G = transform_point(volume.X_GW, p_W);
  const Vec3f extinction = bands.of(volume.mass_extinction) * density_at(volume, p_G);
  const Vec3f scattering = extinction * bands.of(volume.albedo);
  point->extinction += extinction;
  point->scattering += scattering;
  if (glows) point->emission += (extinction - scattering) * glow_at(media, volume, p_G, bands);
  point->g_scattering += scattering * bands.of(volume.g);
}

GLOAM_HD void add(const MediumPoint& point, float weight, MediumPoint* sum) {
  sum->extinction += point.extinction * weight;
  sum->scattering += point.scattering * weight;
  sum->emission += point.emission * weight;
  sum->g_scattering += point.g_scattering * weight;
}

/// (1 - e^-x) / x without cancellation.
GLOAM_HD float mean_transmittance(float x) {
  return x < 1e-2f ? 1.0f - x * (0.5f - x * (1.0f / 6)) : (1.0f - expf(-x)) / x;
}
GLOAM_HD Vec3f mean_transmittance(Vec3f x) {
  return {mean_transmittance(x.x), mean_transmittance(x.y), mean_transmittance(x.z)};
}

}  // namespace media

GLOAM_HD MediumPoint medium_at(const MediaView& media, Vec3f p_W, Bands bands) {
  MediumPoint point;
  for (uint32_t i = 0; i < media.volumes.size; ++i) {
    const VolumeView& volume = media.volumes[i];
    if (media::is_inside(volume, transform_point(volume.X_GW, p_W))) {
      media::add_volume(media, volume, p_W, bands, &point);
    }
  }
  return point;
}

/// Scattering coefficient times phase function of all media at a point [1/(m sr)]: with a cosine of
/// -1, what a LiDAR's backscatter is made of.
GLOAM_HD Vec3f scattering_at(const MediaView& media, Vec3f p_W, Bands bands, float cosine) {
  Vec3f sum;
  for (uint32_t i = 0; i < media.volumes.size; ++i) {
    const VolumeView& volume = media.volumes[i];
    const Vec3f p_G = transform_point(volume.X_GW, p_W);
    if (!media::is_inside(volume, p_G)) continue;
    float pdf;
    const Vec3f phase = eval_phase(volume, bands, {}, cosine, &pdf);
    sum += phase * bands.of(volume.mass_extinction) * bands.of(volume.albedo) *
           media::density_at(volume, p_G);
  }
  return sum;
}

struct MarchResult {
  Vec3f transmittance;
  Vec3f radiance;   ///< of emission and source [cd/m²]
  Vec3f scattered;  ///< fraction that was scattered on its way, of light that is even all around
};

/// A step through media.
struct MarchStep {
  MediumPoint medium;   ///< its mean
  float begin, length;  ///< along the ray [m]
  Vec3f weight;         ///< transmittance from its points to the origin, integrated over it [m]
  bool is_hot;          ///< something around it may glow
};

/// Distance [m] of a place in a step, as likely as light from there gets to the ray's origin: what
/// is scattered in a long step through thick smoke comes from its near end. `u` in [0, 1).
GLOAM_HD float place_in(const MarchStep& step, float u) {
  const float k = step.medium.extinction.y;
  if (k * step.length < 1e-3f) return step.begin + u * step.length;
  return min(step.begin - logf(1 - u * (1 - expf(-k * step.length))) / k, step.begin + step.length);
}

namespace media {

/// Edge of the parts [m] that a step is cut into where something glows: a voxel, and less where
/// temperatures differ, with which light grows so steeply that it changes severalfold from voxel to
/// voxel.
GLOAM_HD float glow_step(const MediumWalk& walk, Bands bands) {
  float step = 1e30f;
  for (int i = 0; i < walk.count(); ++i) {
    const VolumeView& v = walk[i].volume();
    if (!(walk[i].high() > 0) || !glows(v, walk[i].hottest(), bands)) continue;
    const float part = v.temperature.empty() ? 1.0f : 0.25f;
    step = min(step, part * min(v.voxel.x, min(v.voxel.y, v.voxel.z)));
  }
  return step;
}

}  // namespace media

namespace media {

/// Transmittance below which nothing behind is seen.
inline constexpr float kMinTransmittance = 1e-3f;

/// Distance [m] at which the ray leaves the last volume, or even media alone hide what follows.
/// `walk` is at its beginning.
GLOAM_HD float end_of_view(const MediumWalk& walk, Bands bands) {
  constexpr float kMaxOpticalDepth = 7;
  float end = 0, hidden = 3e38f;
  for (int i = 0; i < walk.count(); ++i) {
    const VolumeView& v = walk[i].volume();
    end = max(end, walk[i].end());
    if (!v.density.empty() || v.fade > 0) continue;
    const Vec3f k = bands.of(v.mass_extinction) * v.even_density;
    const float clearest = min(k.x, min(k.y, k.z));
    if (clearest * (walk[i].end() - walk[i].to()) > kMaxOpticalDepth)
      hidden = min(hidden, walk[i].to() + kMaxOpticalDepth / clearest);
  }
  return min(end, hidden);
}

}  // namespace media

/// Marches through the media in steps of at most `step` [m], or longer ones where that would take
/// more than about `max_steps`. Empty cells are skipped. Along a step all is as in its middle and
/// Beer-Lambert's law is integrated, so even media are exact with any step.
/// Emission along the ray counts if `glows`.
/// `source(const MarchStep&)`: light that media scatter towards the ray's origin [cd/m² per m].
template <class Source>
GLOAM_HD MarchResult march(const MediaView& media, const Ray& ray, float tmax, float step,
                           int max_steps, Bands bands, bool glows, const Source& source) {
  MarchResult result;
  result.transmittance = {1, 1, 1};
  MediumWalk walk(media, ray, tmax);
  if (!walk.is_over()) {
    const float way = media::end_of_view(walk, bands) - walk.to();
    step = max(step, way / static_cast<float>(max_steps));
  }
  for (float t = 0; !walk.is_over(); t = walk.to(), walk.advance()) {
    bool is_empty = true;
    bool is_hot = false;
    for (int i = 0; i < walk.count(); ++i) {
      if (!(walk[i].high() > 0)) continue;
      is_empty = false;
      is_hot = is_hot || media::glows(walk[i].volume(), walk[i].hottest(), bands);
    }
    const float length = walk.to() - t;
    if (is_empty || !(length > 0)) continue;
    // Quotients that round to nothing are one step, too.
    const float steps = max(ceilf(length / step), 1.0f);
    const float ds = length / steps;
    const float parts = glows ? max(ceilf(ds / media::glow_step(walk, bands)), 1.0f) : 1.0f;
    const float part = ds / parts;
    for (float i = 0; i < steps; ++i) {
      const float begin = t + i * ds;
      const Vec3f before = result.transmittance;
      MediumPoint mean;
      for (float k = 0; k < parts; ++k) {
        const Vec3f p_W = ray.o + ray.d * (begin + (k + 0.5f) * part);
        MediumPoint point;
        for (int v = 0; v < walk.count(); ++v) {
          const VolumeView& volume = walk[v].volume();
          if (!(walk[v].high() > 0)) continue;
          media::add_volume(media, volume, p_W, bands, &point,
                            glows && media::glows(volume, walk[v].hottest(), bands));
        }
        const Vec3f depth = point.extinction * part;
        if (glows)
          result.radiance +=
              result.transmittance * media::mean_transmittance(depth) * point.emission * part;
        result.transmittance *= media::exp_of(-depth);
        media::add(point, 1 / parts, &mean);
      }
      const Vec3f weight = before * media::mean_transmittance(mean.extinction * ds) * ds;
      result.scattered += weight * mean.scattering;
      result.radiance += weight * source(MarchStep{mean, begin, ds, weight, is_hot});
      if (max_component(result.transmittance) < media::kMinTransmittance) return result;
    }
  }
  return result;
}

}  // namespace gloam
