#pragma once
// Chunk records, compressed where that is worth it.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mcap/compression.h"
#include "mcap/mcap_records.h"

namespace gloam {

/// Records of a chunk that was stored without compression.
struct McapStoredRecords {
  size_t begin = 0, size = 0;  ///< in the buffer that they were appended to [bytes]
  uint32_t crc = 0;
};

/// Appends a chunk of `records`; times come from `index`, whose length, sizes and compression are
/// set. `compressor`: null = none. What hardly becomes smaller is stored as it is: reading it then
/// costs nothing.
std::optional<McapStoredRecords> append_chunk(std::span<const uint8_t> records,
                                              ZstdCompressor* compressor, std::vector<uint8_t>* out,
                                              McapChunkIndex* index);

}  // namespace gloam
