#pragma once
// Content and state hashes: XXH3, 64 bits, the same on every machine of one byte order.

#include <cstdint>
#include <span>
#include <string>

namespace gloam {

/// Hash of a block of bytes, chained from `seed` (the hash of what came before).
uint64_t hash_bytes(const void* data, size_t size, uint64_t seed = 0);

template <class T>
uint64_t hash_span(std::span<const T> values, uint64_t seed = 0) {
  return hash_bytes(values.data(), values.size_bytes(), seed);
}

/// 16 lower-case hexadecimal digits.
std::string hash_to_hex(uint64_t hash);

}  // namespace gloam
