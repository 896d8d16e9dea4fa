#pragma once
// Light's way through participating media. The extinctions of all volumes at a point add up.
// Unbiased: free paths and transmittances by null collisions (Woodcock et al. 1965; Novák et al.
// 2014, "Residual ratio tracking"). Device-safe.

#include "render/kernel/math/sampler.h"
#include "render/kernel/media/medium_walk.h"
#include "render/kernel/media/phase.h"

namespace gloam {

/// Random numbers of one random walk, of which there may be many: hashes of one point of the
/// sampler, so that what comes after keeps its place in the sequence.
class WalkRandom {
 public:
  GLOAM_HD explicit WalkRandom(Vec2f u)
      : state_(mix_bits(static_cast<uint32_t>(u.x * 0x1p24f))),
        step_(mix_bits(static_cast<uint32_t>(u.y * 0x1p24f) ^ 0x9E3779B9u) | 1u) {}
  GLOAM_HD float next() {
    state_ += step_;
    return static_cast<float>(mix_bits(state_) >> 8) * 0x1p-24f;
  }

 private:
  uint32_t state_, step_;
};

/// Event that ends a ray on its way to tmax: scattering, or arrival.
struct MediumEvent {
  float t = 0;      ///< distance at which it is scattered, or tmax [m]
  int volume = -1;  ///< row of the volume that scatters it; -1 = it arrives
  Vec3f weight;     ///< per band, of the light that comes from there
  Vec3f emission;   ///< what the media on the way send back along the ray [cd/m²]
};

namespace media {

/// Fraction of its distance by which a walk moves on at least: less would be lost to rounding, and
/// where a medium is that thick far away, the walk would not end.
inline constexpr float kLeastStep = 1.2e-7f;

GLOAM_HD Vec3f exp_of(Vec3f x) { return {expf(x.x), expf(x.y), expf(x.z)}; }

/// Density [kg/m³] that sets the rate of collisions in the cell: at least its upper bound. Where
/// something glows there are so many that a ray gathers its light from every voxel: flames are
/// thin, and their light changes severalfold from voxel to voxel (Simon et al. 2017, "Line
/// integration for rendering heterogeneous emissive volumes").
GLOAM_HD float collision_density(const CellWalk& cell, Bands bands) {
  constexpr float kPerVoxel = 0.75f;
  const VolumeView& v = cell.volume();
  const bool is_even = v.temperature.empty() && cell.low() == cell.high();
  if (is_even || !(cell.high() > 0) || !glows(v, cell.hottest(), bands)) return cell.high();
  const Vec3f k = bands.of(v.mass_extinction);
  const float rate = (k.x + k.y + k.z) * (1.0f / 3) * min(v.voxel.x, min(v.voxel.y, v.voxel.z));
  return rate > 0 ? max(cell.high(), kPerVoxel / rate) : cell.high();
}

/// Weight one for all emission, for sample_distance().
struct AllGlow {
  GLOAM_HD float operator()(const VolumeView&, Vec3f, Vec3f) const { return 1; }
};

}  // namespace media

/// Samples where the ray is scattered first. One band makes the decisions, sampled in proportion to
/// `throughput`; `weight` is the balance heuristic's over the three that might have made them
/// (Miller et al. 2019, "A null-scattering path integral formulation of light transport"), so
/// dot(probabilities, weight) <= 1. Per density, null collisions are as likely in every band, so
/// that their probabilities drop out of it. `u`: for the band and the first distance, [0, 1)²; well
/// spread points pay there. `random`: for all else. emission_weight(volume, p_W, p_G): factor on
/// the emission there.
template <class EmissionWeight = media::AllGlow>
GLOAM_HD MediumEvent sample_distance(const MediaView& media, const Ray& ray, float tmax,
                                     Bands bands, Vec3f throughput, Vec2f u, WalkRandom random,
                                     const EmissionWeight& emission_weight = {}) {
  MediumEvent event;
  event.t = tmax;
  event.weight = {1, 1, 1};
  MediumWalk walk(media, ray, tmax);
  if (walk.is_over()) return event;

  const Vec3f probabilities = band_probabilities(throughput);
  const int hero = sample_band(probabilities, u.x);
  float wanted = -logf(1.0f - u.y);  // optical depth of bounds to the next collision
  Vec3f excess;                      // optical depth of bounds since the last, over the hero's
  float t = 0;
  const auto settle = [&](Vec3f factor) {
    const Vec3f q = event.weight * media::exp_of(-excess) * factor;
    event.weight = q / dot(probabilities, q);
    excess = {};
  };
  for (; !walk.is_over(); walk.advance()) {
    Vec3f bound;  // of the extinction [1/m]
    for (int i = 0; i < walk.count(); ++i) {
      bound +=
          bands.of(walk[i].volume().mass_extinction) * media::collision_density(walk[i], bands);
    }
    const Vec3f over = bound - Vec3f{bound[hero], bound[hero], bound[hero]};
    while (bound[hero] * (walk.to() - t) > wanted) {
      const float step = max(wanted / bound[hero], media::kLeastStep * t);
      t += step;
      excess += over * step;
      wanted = -logf(1.0f - random.next());
      // Each volume collides as often as its bound says.
      float pick = random.next() * bound[hero];
      int i = 0;
      for (int k = 0; k < walk.count() && pick >= 0; ++k) {
        const float rate = bands.of(walk[k].volume().mass_extinction)[hero] *
                           media::collision_density(walk[k], bands);
        if (rate > 0) i = k;
        pick -= rate;
      }
      const VolumeView& volume = walk[i].volume();
      const float high = media::collision_density(walk[i], bands), low = walk[i].low();
      settle(bands.of(volume.mass_extinction));
      const float sampled = random.next() * high;
      const bool glows = media::glows(volume, walk[i].hottest(), bands);
      const Vec3f p_W = ray.o + ray.d * t, p_G = transform_point(volume.X_GW, p_W);
      const float density = sampled < low && !glows ? low : media::density_at(volume, p_G);
      const Vec3f albedo = bands.of(volume.albedo);
      if (glows) {
        event.emission += event.weight * (Vec3f{1, 1, 1} - albedo) *
                          media::glow_at(media, volume, p_G, bands) *
                          (density / high * emission_weight(volume, p_W, p_G));
      }
      if (sampled < density) {
        event.t = t;
        event.volume = static_cast<int>(&volume - media.volumes.data);
        event.weight *= albedo;
        return event;
      }
    }
    wanted -= bound[hero] * (walk.to() - t);
    excess += over * (walk.to() - t);
    t = walk.to();
  }
  settle({1, 1, 1});
  return event;
}

/// Transmittance, per band. Where the bounds of the density meet (an even medium),
/// exact; elsewhere an estimate between 0 and 1 up to roulette.
GLOAM_HD Vec3f transmittance(const MediaView& media, const Ray& ray, float tmax, Bands bands,
                             WalkRandom random) {
  // Transmittance below which roulette begins: few rays carry on for many.
  constexpr float kRoulette = 0.1f;
  Vec3f passed{1, 1, 1};
  for (uint32_t i = 0; i < media.volumes.size; ++i) {
    const VolumeView& volume = media.volumes[i];
    CellWalk walk;
    const Vec3f k = bands.of(volume.mass_extinction);
    const float k_max = max_component(k);
    if (!(k_max > 0) || !walk.start(volume, ray, tmax)) continue;
    const Vec3f relative = k / k_max;
    float mass = 0;           // per area, of the lower bounds [kg/m²]
    float t = 0, wanted = 0;  // optical depth between the bounds to the next collision
    do {
      const float low = walk.low(), range = walk.high() - low, rate = k_max * range;
      mass += low * (walk.to() - t);
      if (wanted <= 0 && rate > 0) wanted = -logf(1.0f - random.next());
      while (rate * (walk.to() - t) > wanted) {
        t += max(wanted / rate, media::kLeastStep * t);
        wanted = -logf(1.0f - random.next());
        const Vec3f p_G = transform_point(volume.X_GW, ray.o + ray.d * t);
        const float part = clamp((media::density_at(volume, p_G) - low) / range, 0.0f, 1.0f);
        passed *= Vec3f{1, 1, 1} - relative * part;
        const float most = max_component(passed);
        if (most < kRoulette) {
          if (!(random.next() * kRoulette < most)) return {};
          passed *= kRoulette / most;
        }
      }
      wanted -= rate * (walk.to() - t);
      t = walk.to();
    } while (walk.advance());
    passed *= media::exp_of(k * -mass);
  }
  return passed;
}

}  // namespace gloam
