#pragma once
// A LiDAR's pulse in participating media: Beer and Lambert's law in the sensor's own band, and what
// comes back from the medium itself (Rasshofer, Spies and Spies 2011, "Influences of weather
// phenomena on automotive laser radar systems"; Hahner et al. 2021, "Fog simulation on real LiDAR
// point clouds for 3D object detection in adverse weather"). Device-safe.

#include "render/kernel/lidar/lidar_particles.h"
#include "render/kernel/media/medium_march.h"

namespace gloam {

/// Gathers the backscatter of media along one beam, in bins of range as deep as the receiver
/// resolves, and finds false returns in it. A bin's signal is
///   pi Int beta T² O(r) / r² dr
/// with the volume backscattering coefficient beta [1/(m sr)]. A run of bins above the threshold is
/// one echo, at its peak. Speckle is left out, as it is of surfaces: its grains at the lens are
/// lambda r / w wide for a spot of width w (Goodman 2007, "Speckle phenomena in optics"), 0.1 to
/// 0.25 mm from 1 to 100 m, so that a lens of 20 mm takes the mean of thousands of them.
class Backscatter {
 public:
  GLOAM_HD Backscatter() = default;
  GLOAM_HD Backscatter(const LidarOptics& optics, const LidarKey& key, LidarEchoes* echoes)
      : optics_(&optics), key_(key), echoes_(echoes) {}

  GLOAM_HD int bin_of(float range) const { return static_cast<int>(range / optics_->resolution); }
  GLOAM_HD float end_of_bin(float range) const {
    return static_cast<float>(bin_of(range) + 1) * optics_->resolution;
  }
  /// Ranges grow from call to call, and [from, to] lies in one bin.
  GLOAM_HD void add(float from, float to, float signal) {
    const float middle = 0.5f * (from + to);
    const int bin = bin_of(middle);
    if (bin != bin_) {
      close();
      if (bin != bin_ + 1) end_run();
      bin_ = bin;
    }
    sum_ += signal;
    moment_ += signal * middle;
  }
  /// One particle's echo; signals that noise does not lift over the threshold are left out.
  GLOAM_HD void add_single(float range, float signal) {
    if (signal > 0 && signal * lidar::kLeastRatio >= optics_->threshold)
      echoes_->add({range, signal, 0});
  }
  GLOAM_HD const LidarKey& key() const { return key_; }
  /// Call behind the last.
  GLOAM_HD void finish() {
    close();
    end_run();
  }

 private:
  /// Signal above which bins are an echo: with noise, all that it may lift over the threshold, by
  /// four standard deviations.
  GLOAM_HD float least() const {
    return optics_->noisy ? optics_->threshold * (1 - 4 / lidar::kLeastRatio) : optics_->threshold;
  }
  GLOAM_HD void close() {
    if (!(sum_ > 0)) return end_run();
    const LidarEcho bin{moment_ / sum_, sum_, 0};
    sum_ = moment_ = 0;
    if (!(bin.signal >= least())) return end_run();
    if (bin.signal > peak_.signal) peak_ = bin;
  }
  GLOAM_HD void end_run() {
    if (peak_.signal > 0) echoes_->add(peak_);
    peak_ = {};
  }

  const LidarOptics* optics_ = nullptr;
  LidarKey key_;
  LidarEchoes* echoes_ = nullptr;
  int bin_ = -1;
  float sum_ = 0, moment_ = 0;
  LidarEcho peak_{};
};

namespace lidar {

/// Length of a step through these media [m]: half a bin, and no longer than a voxel.
GLOAM_HD float media_step(const MediumWalk& walk, float resolution, float length) {
  constexpr float kMostSteps = 512;
  float step = 0.5f * resolution;
  for (int i = 0; i < walk.count(); ++i) {
    const VolumeView& v = walk[i].volume();
    if (!v.density.empty()) step = min(step, min(v.voxel.x, min(v.voxel.y, v.voxel.z)));
  }
  return max(step, length / kMostSteps);
}

/// Adds those particles of a volume that lie in [from, to] of the ray, one by one. `fraction`:
/// fraction of the pulse at `from`; `way`: the range at the ray's origin.
GLOAM_HD void add_particles(const LidarOptics& optics, uint32_t row, float from, float to,
                            float way, float density, float extinction, float fraction,
                            Backscatter* soft) {
  const LidarParticles& set = optics.particles[row];
  const uint32_t last = min(cell_of(way + to), set.cells.size - 1);
  for (uint32_t cell = cell_of(way + from); cell <= last; ++cell) {
    const CellParticles particles(optics, soft->key(), row, cell);
    for (int i = 0; i < particles.count(); ++i) {
      const ParticleHit hit = particles[i];
      const float t = hit.range - way;
      if (t < from || t >= to || hit.rank * set.density >= density) continue;
      const float one_way = fraction * expf(-extinction * (t - from));
      soft->add_single(hit.range, hit.signal * sqr(one_way));
    }
  }
}

}  // namespace lidar

/// Fraction of a pulse that media let through along [0, length] of the ray. `way` and `fraction`:
/// the range and the one-way fraction of the pulse at its origin. What comes back is added to
/// `soft`, unless that is null.
GLOAM_HD float cross_media(const MediaView& media, const LidarOptics& optics, const Ray& ray,
                           float length, float way, float fraction, Backscatter* soft) {
  const Bands bands = Bands::only(optics.band);
  float passed = 1;
  MediumWalk walk(media, ray, length);
  const float step = lidar::media_step(walk, optics.resolution, length);
  for (float t = 0; !walk.is_over(); t = walk.to(), walk.advance()) {
    bool is_empty = true;
    for (int i = 0; i < walk.count(); ++i) is_empty = is_empty && walk[i].high() <= 0;
    if (is_empty) continue;
    for (float from = t; from < walk.to();) {
      float to = min(walk.to(), from + step);
      if (soft != nullptr) {
        // The overlap grows as the square of the range at first: no long steps near the sensor.
        constexpr float kStepGrowth = 0.2f;
        to = min(to, from + kStepGrowth * max(way + from, 0.01f));
        to = min(to, max(soft->end_of_bin(way + from) - way, from + 1e-3f * step));
      }
      const Vec3f p_W = ray.o + ray.d * (0.5f * (from + to));
      MediumPoint point;
      float backscatter = 0;  // [1/(m sr)]
      for (int v = 0; v < walk.count(); ++v) {
        if (!(walk[v].high() > 0)) continue;
        const VolumeView& volume = walk[v].volume();
        const MediumPoint before = point;
        media::add_volume(media, volume, p_W, bands, &point);
        const auto row = static_cast<uint32_t>(&volume - media.volumes.data);
        if (row < optics.particles.size && !optics.particles[row].classes.empty()) {
          const LidarParticles& set = optics.particles[row];
          if (soft == nullptr || set.cells.empty()) continue;
          const float density = media::density_at(volume, transform_point(volume.X_GW, p_W));
          const uint32_t cell = lidar::cell_of(way + 0.5f * (from + to));
          backscatter += set.cells[min(cell, set.cells.size - 1)].even * density / set.density;
          lidar::add_particles(optics, row, from, to, way, density, before.extinction.x,
                               fraction * passed, soft);
          continue;
        }
        const float ratio = row < optics.lidar_ratios.size ? optics.lidar_ratios[row] : 0;
        backscatter += ratio > 0 ? (point.extinction.x - before.extinction.x) / ratio
                                 : (point.scattering.x - before.scattering.x) *
                                       henyey_greenstein(bands.of(volume.g).x, -1.0f);
      }
      const float depth = point.extinction.x * (to - from);
      if (soft != nullptr && backscatter > 0) {
        const float two_way = sqr(fraction * passed) * media::mean_transmittance(2 * depth);
        soft->add(way + from, way + to,
                  kPi * backscatter * two_way * lidar::overlap(optics, way + 0.5f * (from + to)) *
                      (to - from) / ((way + from) * (way + to)));
      }
      passed *= expf(-depth);
      if (passed * fraction < 1e-4f) return 0;  // of 1e-8 of the pulse, nothing is detected
      from = to;
    }
  }
  return passed;
}

}  // namespace gloam
