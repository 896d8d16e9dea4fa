#pragma once
// Counter-based random numbers: a draw is a pure function of its key (seed, stream, counter,
// index), so any thread can make any draw in any order. Philox4x32-10, Salmon et al. 2011,
// "Parallel random numbers: as easy as 1, 2, 3". Device-safe.

#include "base/device.h"

namespace gloam {

struct Philox4 {
  uint32_t v[4];
};

/// Ten rounds of Philox4x32 over the 128-bit counter under the 64-bit key.
GLOAM_HD Philox4 philox4x32(uint64_t key, uint64_t counter_hi, uint64_t counter_lo) {
  uint32_t c0 = static_cast<uint32_t>(counter_lo), c1 = static_cast<uint32_t>(counter_lo >> 32);
  uint32_t c2 = static_cast<uint32_t>(counter_hi), c3 = static_cast<uint32_t>(counter_hi >> 32);
  uint32_t k0 = static_cast<uint32_t>(key), k1 = static_cast<uint32_t>(key >> 32);
  for (int round = 0; round < 10; ++round) {
    const uint64_t p0 = 0xD2511F53ull * c0, p1 = 0xCD9E8D57ull * c2;
    const uint32_t n0 = static_cast<uint32_t>(p1 >> 32) ^ c1 ^ k0,
                   n2 = static_cast<uint32_t>(p0 >> 32) ^ c3 ^ k1;
    c1 = static_cast<uint32_t>(p1);
    c3 = static_cast<uint32_t>(p0);
    c0 = n0;
    c2 = n2;
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  return {{c0, c1, c2, c3}};
}

/// Uniform in [0, 1) with 24 bits.
GLOAM_HD float uniform_float(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }
/// Uniform in [0, 1) with 53 bits.
GLOAM_HD double uniform_double(uint32_t hi, uint32_t lo) {
  return static_cast<double>(((static_cast<uint64_t>(hi) << 32) | lo) >> 11) * 0x1p-53;
}

/// A named random stream: draws keyed (seed, stream, counter, index).
struct RandomStream {
  uint64_t seed = 0;
  uint32_t stream = 0;  ///< which user of randomness: hash of its name

  GLOAM_HD Philox4 draw(uint64_t counter, uint32_t index) const {
    return philox4x32(seed, (static_cast<uint64_t>(stream) << 32) | index, counter);
  }
  GLOAM_HD double uniform(uint64_t counter, uint32_t index) const {
    const Philox4 d = draw(counter, index);
    return uniform_double(d.v[0], d.v[1]);
  }
};

/// 32-bit FNV-1a, to name streams at compile time: `stream_id("camera.noise")`.
constexpr uint32_t stream_id(const char* name) {
  uint32_t hash = 2166136261u;
  for (; *name != 0; ++name) hash = (hash ^ static_cast<uint32_t>(*name)) * 16777619u;
  return hash;
}

}  // namespace gloam
