#pragma once
// Phase function: directions into which a medium scatters (Henyey and Greenstein 1941, "Diffuse
// radiation in the galaxy"). Cosines are between the directions of flight before and after.
// Device-safe.

#include "render/kernel/media/medium_view.h"

namespace gloam {

/// [1/sr]; its integral over the sphere is 1, its mean cosine g.
GLOAM_HD float henyey_greenstein(float g, float cosine) {
  const float d = max(1.0f + g * g - 2.0f * g * cosine, 1e-12f);
  return (1.0f - g * g) / (4.0f * kPi * d * square_root(d));
}

/// Cosine with that density, u in [0, 1).
GLOAM_HD float sample_henyey_greenstein(float g, float u) {
  const float s = 1.0f - 2.0f * u;
  if (fabsf(g) < 1e-3f) return s + 1.5f * g * (1.0f - s * s);  // to first order in g
  const float a = (1.0f - g * g) / (1.0f + g * s);
  return clamp((1.0f + g * g - a * a) / (2.0f * g), -1.0f, 1.0f);
}

/// Probabilities of the bands for the decisions that one alone can make: in proportion to a path's
/// throughput, the sum over the bands never grows (Wilkie et al. 2014, "Hero wavelength spectral
/// sampling").
GLOAM_HD Vec3f band_probabilities(Vec3f throughput) {
  const float sum = throughput.x + throughput.y + throughput.z;
  return sum > 0 ? throughput / sum : Vec3f{1.0f / 3, 1.0f / 3, 1.0f / 3};
}
GLOAM_HD int sample_band(Vec3f probability, float u) {
  if (u < probability.x) return 0;
  if (probability.y > 0 && (u < probability.x + probability.y || !(probability.z > 0))) return 1;
  return probability.z > 0 ? 2 : 0;  // never a band of probability zero, however the sum is rounded
}

/// Per band [1/sr]. `pdf`: of sample_phase() with the same throughput.
GLOAM_HD Vec3f eval_phase(const VolumeView& volume, Bands bands, Vec3f throughput, float cosine,
                          float* pdf) {
  const Vec3f g = bands.of(volume.g);
  const Vec3f p{henyey_greenstein(g.x, cosine), henyey_greenstein(g.y, cosine),
                henyey_greenstein(g.z, cosine)};
  *pdf = dot(band_probabilities(throughput), p);
  return p;
}

struct PhaseSample {
  Vec3f wi;       ///< where the path goes on, unit
  float pdf = 0;  ///< [1/sr]
  Vec3f weight;   ///< phase / pdf, per band
};

/// `d`: direction of flight before, unit. `throughput`: of the path as it is scattered, the weight
/// of sample_distance() included.
GLOAM_HD PhaseSample sample_phase(const VolumeView& volume, Bands bands, Vec3f throughput, Vec3f d,
                                  float u_band, Vec2f u) {
  PhaseSample sample;
  const int band = sample_band(band_probabilities(throughput), u_band);
  const float z = sample_henyey_greenstein(bands.of(volume.g)[band], u.x);
  const float r = safe_sqrt(1.0f - z * z);
  float s, c;
  sincos_turn(u.y, &s, &c);
  sample.wi = Frame::from_z(d).to_world({r * c, r * s, z});
  const Vec3f p = eval_phase(volume, bands, throughput, z, &sample.pdf);
  sample.weight = p / sample.pdf;
  return sample;
}

}  // namespace gloam
