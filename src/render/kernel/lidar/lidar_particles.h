#pragma once
// Drops and flakes in a LiDAR's beam, one by one where they are few, and the overlap of its beam
// and its receiver. A particle with the differential backscattering cross-section s [m²/sr] at
// range r sends back
//   p = pi w s T² O(r) / r²,  w = 2 / (pi a b) exp(-2 rho²)
// relative to a white plate 1 m away: w [1/m²] is the profile of a Gaussian beam with the half
// widths a and b at 1/e², rho the distance from its axis in these, O the overlap. Device-safe.

#include "render/kernel/lidar/lidar_detect.h"

namespace gloam::lidar {

/// Length of the cells of range that particles are sampled in [m].
inline constexpr float kCell = 0.5f;
/// Radius of the beam in which particles are sampled, in half widths at 1/e²: beyond it is a 90th
/// of the power on the axis.
inline constexpr float kSampledBeamRadius = 1.5f;
/// Least half width of a beam [m].
inline constexpr float kThinnest = 5e-4f;

/// Half widths of the beam at 1/e², across and up [m].
GLOAM_HD Vec2f half_widths(const LidarOptics& optics, float range) {
  const Vec2f spread = optics.divergence * range;
  return {max(0.5f * sqrtf(sqr(optics.beam_size.x) + sqr(spread.x)), kThinnest),
          max(0.5f * sqrtf(sqr(optics.beam_size.y) + sqr(spread.y)), kThinnest)};
}

/// Area that two discs share, `apart` their centres' distance.
GLOAM_HD float shared_area(float a, float b, float apart) {
  const float less = min(a, b), more = max(a, b);
  if (apart >= a + b) return 0;
  if (apart <= more - less) return kPi * sqr(less);
  const auto angle = [](float cosine) { return acosf(max(-1.0f, min(1.0f, cosine))); };
  const float at_a = angle((sqr(apart) + sqr(a) - sqr(b)) / (2 * apart * a));
  const float at_b = angle((sqr(apart) + sqr(b) - sqr(a)) / (2 * apart * b));
  return sqr(a) * (at_a - 0.5f * sinf(2 * at_a)) + sqr(b) * (at_b - 0.5f * sinf(2 * at_b));
}

/// Fraction of the light from a point `aside` m off the receiver's axis that its detector sees, of
/// what has entered the lens: that within half the field of view of the axis (geometrical form
/// factor, as in Measures 1984, "Laser remote sensing", 7.2). 0 … 1.
GLOAM_HD float overlap_of_point(const LidarOptics& optics, float range, float aside) {
  const float lens = 0.5f * optics.receiver_diameter, seen = 0.5f * optics.receiver_view * range;
  return shared_area(lens, seen, fabsf(aside)) / (kPi * sqr(lens));
}

/// The same of the whole beam, which is parallel to the receiver's axis: near by, the side of it
/// that is turned to the lens is seen first. Mean over the Gaussian profile across, as it leaves
/// the sensor, by Gauss and Hermite's quadrature with three points. The field of view is that of a
/// beam as it diverges.
GLOAM_HD float overlap(const LidarOptics& optics, float range) {
  const float lens = 0.5f * optics.receiver_diameter;
  if (!(lens > 0)) return 1;
  const float across = 0.4330127f * optics.beam_size.x;  // sqrt(3) standard deviations
  const float middle = optics.receiver_offset;
  if (0.5f * optics.receiver_view * range >= middle + across + lens) return 1;
  return (4 * overlap_of_point(optics, range, middle) +
          overlap_of_point(optics, range, middle - across) +
          overlap_of_point(optics, range, middle + across)) *
         (1.0f / 6);
}

/// Signal of a particle, but for what dims it. `rho2`: squared distance from the beam's axis, in
/// half widths.
GLOAM_HD float particle_signal(const LidarOptics& optics, float range, float backscatter,
                               float rho2) {
  const Vec2f half = half_widths(optics, range);
  return 2 / (half.x * half.y) * expf(-2 * rho2) * backscatter * overlap(optics, range) /
         sqr(range);
}

/// One particle of a cell.
struct ParticleHit {
  float range;   ///< [m]
  float signal;  ///< but for what dims it
  float rank;    ///< uniform in [0, 1): it is there where the density is more than this of full
};

GLOAM_HD uint32_t cell_of(float range) { return static_cast<uint32_t>(range / kCell); }

/// Particles of one cell in one beam: as many as Poisson's law says, anywhere in it. They depend on
/// the key, the volume and the cell alone, not on how the ray is cut into steps.
class CellParticles {
 public:
  GLOAM_HD CellParticles(const LidarOptics& optics, const LidarKey& key, uint32_t row,
                         uint32_t cell)
      : optics_(optics),
        set_(optics.particles[row]),
        cell_(set_.cells[cell]),
        key_(key),
        stream_(stream_id("lidar.particles") ^ row * 0x9E3779B9u),
        index_(cell << 8),
        from_(static_cast<float>(cell) * kCell) {
    if (!(cell_.mean > 0)) return;
    const float u = uniform_float(draw(key_, stream_, index_).v[0]);
    float p = expf(-cell_.mean), sum = p;
    for (; u >= sum && count_ < kMaxParticles; sum += p)
      p *= cell_.mean / static_cast<float>(++count_);
  }
  GLOAM_HD int count() const { return count_; }
  GLOAM_HD ParticleHit operator[](int i) const {
    const uint32_t at = index_ + 1 + 2 * static_cast<uint32_t>(i);
    const Philox4 a = draw(key_, stream_, at), b = draw(key_, stream_, at + 1);
    // Even over the cross-section at the cell's far end; nearer by, some lie beside the beam.
    const float radius = kSampledBeamRadius * sqrtf(uniform_float(a.v[0]));
    float s, c;
    sincos_turn(uniform_float(a.v[1]), &s, &c);
    const float range = from_ + kCell * uniform_float(a.v[2]);
    const Vec2f far = half_widths(optics_, from_ + kCell), here = half_widths(optics_, range);
    const float rho2 = sqr(radius * c * far.x / here.x) + sqr(radius * s * far.y / here.y);
    const float backscatter = set_.classes[class_at(uniform_float(a.v[3]))].backscatter;
    return {range, range > 0 ? particle_signal(optics_, range, backscatter, rho2) : 0.0f,
            uniform_float(b.v[0])};
  }

 private:
  static constexpr int kMaxParticles = 120;
  GLOAM_HD uint32_t class_at(float u) const {
    float sum = 0;
    for (uint32_t i = cell_.first; i < set_.classes.size; ++i) sum += set_.classes[i].number;
    float left = u * sum;
    const uint32_t last = set_.classes.size - 1;
    for (uint32_t i = cell_.first; i < last; ++i) {
      if (left < set_.classes[i].number) return i;
      left -= set_.classes[i].number;
    }
    return last;
  }

  const LidarOptics& optics_;
  const LidarParticles& set_;
  const LidarCell cell_;
  const LidarKey key_;
  const uint32_t stream_, index_;
  const float from_;
  int count_ = 0;
};

}  // namespace gloam::lidar
