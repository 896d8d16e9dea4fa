#include "geometry/mesh/weld.h"

#include <bit>

namespace gloam {
namespace {

struct Key {
  uint32_t x, y, z;
  bool operator==(const Key&) const = default;
};

Key key_of(Vec3f p) {  // + 0: minus zero is zero
  return {std::bit_cast<uint32_t>(p.x + 0.0f), std::bit_cast<uint32_t>(p.y + 0.0f),
          std::bit_cast<uint32_t>(p.z + 0.0f)};
}

uint64_t hash_of(const Key& k) {  // the mixer of SplitMix64 (Steele et al. 2014), twice
  const auto mix = [](uint64_t h) {
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
    return h ^ (h >> 31);
  };
  return mix(mix((uint64_t{k.x} << 32) | k.y) + k.z);
}

}  // namespace

TriangleMesh weld(const std::vector<Vec3f>& corners) {
  constexpr uint32_t kEmpty = UINT32_MAX;
  TriangleMesh out;
  out.indices.resize(corners.size());
  std::vector<uint32_t> slots(std::bit_ceil(2 * corners.size() + 2), kEmpty);
  const size_t mask = slots.size() - 1;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Key key = key_of(corners[i]);
    size_t slot = hash_of(key) & mask;
    while (slots[slot] != kEmpty && key_of(out.positions[slots[slot]]) != key)
      slot = (slot + 1) & mask;
    if (slots[slot] == kEmpty) {
      slots[slot] = static_cast<uint32_t>(out.positions.size());
      out.positions.push_back(corners[i]);
    }
    out.indices[i] = slots[slot];
  }
  return out;
}

}  // namespace gloam
