#include "mcap/crc32.h"

#include <zlib.h>

namespace gloam {

uint32_t crc32_of(std::span<const uint8_t> bytes, uint32_t before) {
  return static_cast<uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

uint32_t crc32_join(uint32_t crc_a, uint32_t crc_b, uint64_t size_b) {
  return static_cast<uint32_t>(::crc32_combine(crc_a, crc_b, static_cast<z_off_t>(size_b)));
}

}  // namespace gloam
