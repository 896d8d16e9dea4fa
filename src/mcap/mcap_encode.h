#pragma once
// Records -> bytes, appended to a buffer.

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "mcap/mcap_records.h"

namespace gloam {

using McapBytes = std::vector<uint8_t>;

/// Record that is being appended: the constructor writes the opcode, the destructor the length.
class McapRecordScope {
 public:
  McapRecordScope(McapBytes* out, McapOp op);
  ~McapRecordScope();
  McapRecordScope(const McapRecordScope&) = delete;
  McapRecordScope& operator=(const McapRecordScope&) = delete;

  void put_u8(uint8_t v) { out_->push_back(v); }
  void put_u16(uint16_t v) { put(v, 2); }
  void put_u32(uint32_t v) { put(v, 4); }
  void put_u64(uint64_t v) { put(v, 8); }
  void put_text(std::string_view text);            ///< length as uint32 first
  void put_bytes(std::span<const uint8_t> bytes);  ///< without a length
  void put_strings(const McapStrings& strings);    ///< length in bytes as uint32 first
  void put_counts(const McapCounts& counts);

 private:
  void put(uint64_t v, int bytes);

  McapBytes* out_;
  size_t begin_;
};

/// Replaces the eight bytes at `offset` by `v`, little-endian.
void patch_u64(McapBytes* out, size_t offset, uint64_t v);

void append_magic(McapBytes* out);
void append_record(McapBytes* out, const McapHeader& header);
void append_record(McapBytes* out, const McapSchema& schema);
void append_record(McapBytes* out, const McapChannel& channel);
void append_record(McapBytes* out, const McapMessage& message);
void append_record(McapBytes* out, const McapChunkIndex& index);
/// With its CRC.
void append_record(McapBytes* out, const McapAttachment& attachment);
void append_record(McapBytes* out, const McapAttachmentIndex& index);
void append_record(McapBytes* out, const McapMetadata& metadata);
void append_record(McapBytes* out, const McapMetadataIndex& index);
void append_record(McapBytes* out, const McapStatistics& statistics);
void append_record(McapBytes* out, const McapSummaryOffset& offset);
/// Footer over the summary that `out` holds from `summary_begin` on: its CRC is computed here.
void append_footer(McapBytes* out, McapFooter footer, size_t summary_begin);
void append_data_end(McapBytes* out, uint32_t data_crc);
/// `entries`: log time and offset in the uncompressed chunk of each message of the channel.
void append_message_index(McapBytes* out, uint16_t channel,
                          std::span<const std::pair<uint64_t, uint64_t>> entries);

}  // namespace gloam
