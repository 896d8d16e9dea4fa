#pragma once
// Stateless sample points: the two first Sobol' dimensions, Owen-scrambled and shuffled anew for
// every pair of dimensions (Burley 2020, "Practical hash-based Owen scrambling"), indexed along a
// Morton curve over the picture so that neighbouring pixels share one sequence and their errors
// differ (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of Monte Carlo sampling error").
// A draw is a function of (seed, frame, pixel, sample, dimension) alone. Device-safe.

#include "render/kernel/math/lanes.h"

namespace gloam {

template <class U>
GLOAM_HD U reverse_bits(U x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00FF00FFu) << 8) | ((x & 0xFF00FF00u) >> 8);
  x = ((x & 0x0F0F0F0Fu) << 4) | ((x & 0xF0F0F0F0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xCCCCCCCCu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xAAAAAAAAu) >> 1);
}

/// Bijection of 32 bits in which every output bit depends on every input bit.
template <class U>
GLOAM_HD U mix_bits(U x) {
  x = (x ^ (x >> 16)) * 0x7FEB352Du;
  x = (x ^ (x >> 15)) * 0x846CA68Bu;
  return x ^ (x >> 16);
}

/// Owen scrambling of a bit-reversed value: bit i changes with the bits below it (constants of
/// Burley 2020).
template <class U>
GLOAM_HD U scramble_reversed(U x, U seed) {
  x += seed;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  x ^= x * 0x8D22F6E6u;
  return x;
}

/// Second Sobol' dimension, bit-reversed: the Pascal matrix modulo 2, a tensor power.
template <class U>
GLOAM_HD U sobol1_reversed(U i) {
  i ^= (i >> 1) & 0x55555555u;
  i ^= (i >> 2) & 0x33333333u;
  i ^= (i >> 4) & 0x0F0F0F0Fu;
  i ^= (i >> 8) & 0x00FF00FFu;
  return i ^ (i >> 16);
}

template <class U>
GLOAM_HD U spread_bits(U x) {
  x &= 0xFFFFu;
  x = (x | (x << 8)) & 0x00FF00FFu;
  x = (x | (x << 4)) & 0x0F0F0F0Fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

template <class F>
class SamplerOf {
 public:
  using Mask = MaskOf<F>;
  using Uint = UintOf<F>;

  /// `log2_samples`: samples per pixel, rounded up to a power of two, of the whole picture.
  GLOAM_HD static SamplerOf make(uint64_t seed, uint32_t frame, Uint x, Uint y, Uint sample,
                                 uint32_t log2_samples) {
    SamplerOf s;
    const Uint morton = spread_bits(x) | (spread_bits(y) << 1);
    s.reversed_index_ = reverse_bits((morton << static_cast<int>(log2_samples)) + sample);
    s.seed_ = mix_bits(static_cast<uint32_t>(seed) ^
                       mix_bits(static_cast<uint32_t>(seed >> 32) ^ mix_bits(frame + 0x9E3779B9u)));
    return s;
  }

  /// One sample of each pixel and turn, for pictures that are averaged over turns and over pixels:
  /// those of four by four pixels share 2^kLog2Turns points, and swap them from turn to turn so
  /// that each pixel comes by all of them, the farthest ones first.
  GLOAM_HD static SamplerOf of_turn(uint64_t seed, Uint x, Uint y, uint32_t turn) {
    constexpr uint32_t kTurns = 1u << kLog2Turns;
    SamplerOf s = make(seed, turn / kTurns, x, y, Uint(0u), 0);
    s.reversed_index_ ^= reverse_bits(Uint(turn % kTurns));
    return s;
  }

  /// Goes on in lane k from where `from`, of the same seed, frame and turn, is in its lane i.
  friend GLOAM_HD void copy_lane(const SamplerOf& from, int i, SamplerOf* to, int k) {
    to->seed_ = from.seed_;
    copy_lane(from.reversed_index_, i, &to->reversed_index_, k);
    copy_lane(from.dimension_, i, &to->dimension_, k);
  }
  /// The given lanes go on as `other`, of the same picture.
  GLOAM_HD void take(Mask lanes, const SamplerOf& other) {
    reversed_index_ = select(lanes, other.reversed_index_, reversed_index_);
    dimension_ = select(lanes, other.dimension_, dimension_);
    seed_ = other.seed_;
  }

  /// Lanes that are not `active` get a number too, but keep their place in the sequence.
  GLOAM_HD F next_1d(Mask active = true) {
    const Uint key = next_key(active);
    const Uint i = reverse_bits(scramble_reversed(reversed_index_, key));
    return to_unit(reverse_bits(scramble_reversed(i, key * Uint(0x9E3779B9u) + Uint(1u))));
  }

  GLOAM_HD Vec2Of<F> next_2d(Mask active = true) {
    const Uint key = next_key(active);
    const Uint i = reverse_bits(scramble_reversed(reversed_index_, key));
    return {to_unit(reverse_bits(scramble_reversed(i, key * Uint(0x9E3779B9u) + Uint(1u)))),
            to_unit(reverse_bits(
                scramble_reversed(sobol1_reversed(i), key * Uint(0x85EBCA6Bu) + Uint(2u))))};
  }

 private:
  static constexpr uint32_t kLog2Turns = 4;

  GLOAM_HD Uint next_key(Mask active) {
    dimension_ += select(active, Uint(1u), Uint(0u));
    return mix_bits(Uint(seed_) + dimension_ * Uint(0x9E3779B9u));
  }
  GLOAM_HD static F to_unit(Uint bits) { return to_float(bits >> 8) * 0x1p-24f; }

  Uint reversed_index_{}, dimension_{};
  uint32_t seed_ = 0;
};
using Sampler = SamplerOf<float>;

}  // namespace gloam
