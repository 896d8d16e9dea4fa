#pragma once
// CRC-32 of IEEE 802.3 (reflected polynomial 0xEDB88320), as MCAP, zlib and PNG use it.

#include <cstdint>
#include <span>

namespace gloam {

/// CRC of the bytes, chained from `before`, the CRC of those in front of them.
uint32_t crc32_of(std::span<const uint8_t> bytes, uint32_t before = 0);

/// CRC of A followed by B, from the CRCs of both and the size of B [bytes].
uint32_t crc32_join(uint32_t crc_a, uint32_t crc_b, uint64_t size_b);

}  // namespace gloam
