#pragma once
// How much of a stranger's log is believed before memory is taken for it.

#include <cstdint>

namespace gloam {

struct McapLimits {
  uint64_t chunk_bytes = uint64_t{256} << 20;      ///< of one chunk or record, in memory
  uint64_t ratio = 1100;                           ///< of a chunk's size to its compressed size,
  uint64_t any_ratio_bytes = uint64_t{16} << 20;   ///< but not asked of chunks up to this size
  uint64_t open_bytes = uint64_t{512} << 20;       ///< of chunks that overlap in time together
  uint64_t definition_bytes = uint64_t{64} << 20;  ///< of all schemas and channels together
  uint64_t summary_bytes = uint64_t{256} << 20;    ///< a larger summary is not used
  uint64_t attachment_bytes = uint64_t{1} << 30;   ///< of one attachment
};

/// False for what only a decompression bomb claims.
inline bool ratio_is_credible(uint64_t compressed, uint64_t uncompressed,
                              const McapLimits& limits) {
  return uncompressed <= limits.any_ratio_bytes || uncompressed / limits.ratio <= compressed;
}

}  // namespace gloam
