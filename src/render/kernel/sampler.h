#pragma once
// Stateless sample points: the two first Sobol' dimensions, Owen-scrambled and shuffled anew for
// every pair of dimensions (Burley 2020, "Practical hash-based Owen scrambling"), indexed along a
// Morton curve over the picture so that neighbouring pixels share one sequence and their errors
// differ (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of Monte Carlo sampling error").
// A draw is a function of (seed, frame, pixel, sample, dimension) alone. Device-safe.

#include "base/vec.h"

namespace gloam {

GLOAM_HD uint32_t reverse_bits(uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00FF00FFu) << 8) | ((x & 0xFF00FF00u) >> 8);
  x = ((x & 0x0F0F0F0Fu) << 4) | ((x & 0xF0F0F0F0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xCCCCCCCCu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xAAAAAAAAu) >> 1);
}

/// Bijection of 32 bits in which every output bit depends on every input bit.
GLOAM_HD uint32_t mix_bits(uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7FEB352Du;
  x = (x ^ (x >> 15)) * 0x846CA68Bu;
  return x ^ (x >> 16);
}

/// Owen scrambling of a bit-reversed value: bit i changes with the bits below it (constants of
/// Burley 2020).
GLOAM_HD uint32_t scramble_reversed(uint32_t x, uint32_t seed) {
  x += seed;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  x ^= x * 0x8D22F6E6u;
  return x;
}

/// Second Sobol' dimension, bit-reversed: the Pascal matrix modulo 2, a tensor power.
GLOAM_HD uint32_t sobol1_reversed(uint32_t i) {
  i ^= (i >> 1) & 0x55555555u;
  i ^= (i >> 2) & 0x33333333u;
  i ^= (i >> 4) & 0x0F0F0F0Fu;
  i ^= (i >> 8) & 0x00FF00FFu;
  return i ^ (i >> 16);
}

GLOAM_HD uint32_t spread_bits(uint32_t x) {
  x &= 0xFFFFu;
  x = (x | (x << 8)) & 0x00FF00FFu;
  x = (x | (x << 4)) & 0x0F0F0F0Fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

class Sampler {
 public:
  /// `log2_samples`: samples per pixel, rounded up to a power of two, of the whole picture.
  GLOAM_HD static Sampler make(uint64_t seed, uint32_t frame, uint32_t x, uint32_t y,
                               uint32_t sample, uint32_t log2_samples) {
    Sampler s;
    const uint32_t morton = spread_bits(x) | (spread_bits(y) << 1);
    s.reversed_index_ = reverse_bits((morton << log2_samples) + sample);
    s.seed_ = mix_bits(static_cast<uint32_t>(seed) ^
                       mix_bits(static_cast<uint32_t>(seed >> 32) ^ mix_bits(frame + 0x9E3779B9u)));
    return s;
  }

  GLOAM_HD float next_1d() {
    const uint32_t key = next_key();
    if (dimension_ > kLowDiscrepancyDraws) return to_float(mix_bits(reversed_index_ ^ key));
    const uint32_t i = reverse_bits(scramble_reversed(reversed_index_, key));
    return to_float(reverse_bits(scramble_reversed(i, key * 0x9E3779B9u + 1u)));
  }

  GLOAM_HD Vec2f next_2d() {
    const uint32_t key = next_key();
    if (dimension_ > kLowDiscrepancyDraws) {
      const uint32_t bits = mix_bits(reversed_index_ ^ key);
      return {to_float(bits), to_float(mix_bits(bits + 0x9E3779B9u))};
    }
    const uint32_t i = reverse_bits(scramble_reversed(reversed_index_, key));
    return {to_float(reverse_bits(scramble_reversed(i, key * 0x9E3779B9u + 1u))),
            to_float(reverse_bits(scramble_reversed(sobol1_reversed(i), key * 0x85EBCA6Bu + 2u)))};
  }

 private:
  /// Draws beyond this many of one path (after three vertices) are plain hashes: what is left
  /// to gain there is less than what the points cost.
  static constexpr uint32_t kLowDiscrepancyDraws = 10;

  GLOAM_HD uint32_t next_key() { return mix_bits(seed_ + (++dimension_) * 0x9E3779B9u); }
  GLOAM_HD static float to_float(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

  uint32_t reversed_index_ = 0, seed_ = 0, dimension_ = 0;
};

}  // namespace gloam
