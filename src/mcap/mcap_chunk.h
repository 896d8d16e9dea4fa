#pragma once
// Chunks of a stranger's log, decompressed within limits and with their CRC checked.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "mcap/log_source.h"
#include "mcap/mcap_limits.h"
#include "mcap/mcap_records.h"

namespace gloam {

/// Memory of chunks, for use after use.
struct McapChunkBuffers {
  std::vector<uint8_t> record;   ///< as in the log
  std::vector<uint8_t> records;  ///< records of the chunk, decompressed
};

/// Checks what a chunk record declares against its content and the limits; what is wrong, or "".
std::string check_chunk(const McapChunkHead& head, const McapLimits& limits);

/// Reads the chunk record at `offset`, of `length` bytes in all, into `buffers`; its front part in
/// return, whose `records` are those in `buffers->record`. Errors name the offset.
Result<McapChunkHead> load_chunk(const LogSource& source, uint64_t offset, uint64_t length,
                                 const McapLimits& limits, McapChunkBuffers* buffers);

/// As load_chunk, of a chunk whose record's content is in `content`, at `offset` of the log.
Result<McapChunkHead> open_chunk(const LogSource& source, uint64_t offset,
                                 std::span<const uint8_t> content, const McapLimits& limits,
                                 std::vector<uint8_t>* records);

}  // namespace gloam
