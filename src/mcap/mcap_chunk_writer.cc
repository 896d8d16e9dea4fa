#include "mcap/mcap_chunk_writer.h"

#include "mcap/crc32.h"
#include "mcap/mcap_encode.h"
#include "mcap/mcap_limits.h"

namespace gloam {
namespace {

constexpr size_t kMinCompressionGain = 64;  // a chunk is compressed if that saves 1/64 of it

/// Appends compression, length and records; false, and nothing is appended, where that is not
/// worth it.
bool append_compressed(std::span<const uint8_t> records, ZstdCompressor* compressor,
                       std::vector<uint8_t>* out, McapRecordScope* record, uint64_t* size) {
  const size_t begin = out->size();
  record->put_text("zstd");
  const size_t length_at = out->size();
  record->put_u64(0);
  const bool smaller =
      compressor->append(records, records.size() - records.size() / kMinCompressionGain, out);
  *size = out->size() - length_at - 8;
  // A chunk is stored, too, where it shrinks by more than the reader takes from strangers.
  if (smaller && ratio_is_credible(*size, records.size(), McapLimits())) {
    patch_u64(out, length_at, *size);
    return true;
  }
  out->resize(begin);
  return false;
}

}  // namespace

std::optional<McapStoredRecords> append_chunk(std::span<const uint8_t> records,
                                              ZstdCompressor* compressor, std::vector<uint8_t>* out,
                                              McapChunkIndex* index) {
  const size_t begin = out->size();
  std::optional<McapStoredRecords> stored;
  {
    McapRecordScope record(out, McapOp::kChunk);
    record.put_u64(index->start_time);
    record.put_u64(index->end_time);
    record.put_u64(records.size());
    const uint32_t crc = crc32_of(records);
    record.put_u32(crc);
    if (compressor != nullptr &&
        append_compressed(records, compressor, out, &record, &index->compressed_size)) {
      index->compression = "zstd";
    } else {
      record.put_text("");
      record.put_u64(records.size());
      stored = McapStoredRecords{out->size(), records.size(), crc};
      record.put_bytes(records);
      index->compressed_size = records.size();
    }
  }
  index->uncompressed_size = records.size();
  index->length = out->size() - begin;
  return stored;
}

}  // namespace gloam
