#include "mcap/mcap_chunk.h"

#include <fmt/format.h>

#include "base/memory.h"
#include "mcap/compression.h"
#include "mcap/crc32.h"
#include "mcap/mcap_decode.h"

namespace gloam {
namespace {

constexpr const char* kRecoverHint = "'gloam recover' keeps all undamaged data";

}  // namespace

std::string check_chunk(const McapChunkHead& head, const McapLimits& limits) {
  if (head.uncompressed_size > limits.chunk_bytes) {
    return fmt::format("a chunk has {} bytes; the limit is {}", head.uncompressed_size,
                       limits.chunk_bytes);
  }
  if (head.compression.empty() && head.uncompressed_size != head.records.size()) {
    return fmt::format("a chunk has {} bytes, but declares {}", head.records.size(),
                       head.uncompressed_size);
  }
  if (!ratio_is_credible(head.records.size(), head.uncompressed_size, limits)) {
    return fmt::format("a chunk declares {} bytes in {} compressed bytes", head.uncompressed_size,
                       head.records.size());
  }
  return {};
}

Result<McapChunkHead> open_chunk(const LogSource& source, uint64_t offset,
                                 std::span<const uint8_t> content, const McapLimits& limits,
                                 std::vector<uint8_t>* records) {
  McapChunkHead head;
  if (!decode(content, &head))
    return mcap_error(source, offset, "a chunk is shorter than it declares", kRecoverHint);
  if (std::string wrong = check_chunk(head, limits); !wrong.empty())
    return mcap_error(source, offset, wrong, kRecoverHint);
  if (head.uncompressed_size > limits.any_ratio_bytes) {
    GLOAM_TRY_STATUS(
        check_memory(head.uncompressed_size, "a chunk of " + source.name(), "free some memory"));
  }
  records->resize(head.uncompressed_size);
  if (std::string wrong = decompress(head.compression, head.records, *records); !wrong.empty())
    return mcap_error(source, offset, "a chunk: " + wrong, kRecoverHint);
  if (head.uncompressed_crc != 0 && head.uncompressed_crc != crc32_of(*records))
    return mcap_error(source, offset, "the CRC of a chunk is wrong", kRecoverHint);
  return head;
}

Result<McapChunkHead> load_chunk(const LogSource& source, uint64_t offset, uint64_t length,
                                 const McapLimits& limits, McapChunkBuffers* buffers) {
  if (offset > source.size() || length > source.size() - offset || length < kMcapRecordHead)
    return mcap_error(source, offset, fmt::format("a chunk of {} bytes is outside the log", length),
                      kRecoverHint);
  // The front part and indexes of one compressed chunk are small beside its records.
  if (length > limits.chunk_bytes + (limits.chunk_bytes >> 4) + 4096)
    return mcap_error(source, offset, fmt::format("a chunk of {} bytes is too large", length));
  buffers->record.resize(length);
  GLOAM_TRY_STATUS(source.read(offset, buffers->record));
  McapRecordCursor cursor(buffers->record);
  if (!cursor.next() || cursor.op() != McapOp::kChunk)
    return mcap_error(source, offset, "expected a chunk here", kRecoverHint);
  return open_chunk(source, offset, cursor.content(), limits, &buffers->records);
}

}  // namespace gloam
