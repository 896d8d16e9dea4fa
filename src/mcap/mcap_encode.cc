#include "mcap/mcap_encode.h"

#include "base/check.h"
#include "mcap/crc32.h"

namespace gloam {

McapRecordScope::McapRecordScope(McapBytes* out, McapOp op) : out_(out) {
  out_->push_back(static_cast<uint8_t>(op));
  begin_ = out_->size();
  put_u64(0);
}

McapRecordScope::~McapRecordScope() { patch_u64(out_, begin_, out_->size() - begin_ - 8); }

void McapRecordScope::put(uint64_t v, int bytes) {
  uint8_t raw[8];
  for (int i = 0; i < bytes; ++i) raw[i] = static_cast<uint8_t>(v >> (8 * i));
  out_->insert(out_->end(), raw, raw + bytes);
}

void McapRecordScope::put_text(std::string_view text) {
  GLOAM_CHECK(text.size() <= UINT32_MAX, "a string in a log can have at most 4 GiB");
  put_u32(static_cast<uint32_t>(text.size()));
  out_->insert(out_->end(), text.begin(), text.end());
}

void McapRecordScope::put_bytes(std::span<const uint8_t> bytes) {
  out_->insert(out_->end(), bytes.begin(), bytes.end());
}

void McapRecordScope::put_strings(const McapStrings& strings) {
  uint64_t size = 0;
  for (const auto& [key, value] : strings) size += 8 + key.size() + value.size();
  GLOAM_CHECK(size <= UINT32_MAX, "a map in a log can have at most 4 GiB");
  put_u32(static_cast<uint32_t>(size));
  for (const auto& [key, value] : strings) {
    put_text(key);
    put_text(value);
  }
}

void McapRecordScope::put_counts(const McapCounts& counts) {
  put_u32(static_cast<uint32_t>(10 * counts.size()));
  for (const auto& [key, value] : counts) {
    put_u16(key);
    put_u64(value);
  }
}

void patch_u64(McapBytes* out, size_t offset, uint64_t v) {
  for (size_t i = 0; i < 8; ++i) (*out)[offset + i] = static_cast<uint8_t>(v >> (8 * i));
}

void append_magic(McapBytes* out) { out->insert(out->end(), kMcapMagic.begin(), kMcapMagic.end()); }

void append_record(McapBytes* out, const McapHeader& header) {
  McapRecordScope record(out, McapOp::kHeader);
  record.put_text(header.profile);
  record.put_text(header.library);
}

void append_record(McapBytes* out, const McapSchema& schema) {
  McapRecordScope record(out, McapOp::kSchema);
  record.put_u16(schema.id);
  record.put_text(schema.name);
  record.put_text(schema.encoding);
  record.put_text({reinterpret_cast<const char*>(schema.data.data()), schema.data.size()});
}

void append_record(McapBytes* out, const McapChannel& channel) {
  McapRecordScope record(out, McapOp::kChannel);
  record.put_u16(channel.id);
  record.put_u16(channel.schema);
  record.put_text(channel.topic);
  record.put_text(channel.encoding);
  record.put_strings(channel.metadata);
}

void append_record(McapBytes* out, const McapMessage& message) {
  McapRecordScope record(out, McapOp::kMessage);
  record.put_u16(message.channel);
  record.put_u32(message.sequence);
  record.put_u64(message.log_time);
  record.put_u64(message.publish_time);
  record.put_bytes(message.data);
}

void append_record(McapBytes* out, const McapChunkIndex& index) {
  McapRecordScope record(out, McapOp::kChunkIndex);
  record.put_u64(index.start_time);
  record.put_u64(index.end_time);
  record.put_u64(index.offset);
  record.put_u64(index.length);
  record.put_counts(index.message_indexes);
  record.put_u64(index.message_index_length);
  record.put_text(index.compression);
  record.put_u64(index.compressed_size);
  record.put_u64(index.uncompressed_size);
}

void append_record(McapBytes* out, const McapAttachment& attachment) {
  McapRecordScope record(out, McapOp::kAttachment);
  const size_t content = out->size();
  record.put_u64(attachment.log_time);
  record.put_u64(attachment.create_time);
  record.put_text(attachment.name);
  record.put_text(attachment.media_type);
  record.put_u64(attachment.data.size());
  record.put_bytes(attachment.data);
  record.put_u32(crc32_of(std::span<const uint8_t>(*out).subspan(content)));
}

void append_record(McapBytes* out, const McapAttachmentIndex& index) {
  McapRecordScope record(out, McapOp::kAttachmentIndex);
  record.put_u64(index.offset);
  record.put_u64(index.length);
  record.put_u64(index.log_time);
  record.put_u64(index.create_time);
  record.put_u64(index.data_size);
  record.put_text(index.name);
  record.put_text(index.media_type);
}

void append_record(McapBytes* out, const McapMetadata& metadata) {
  McapRecordScope record(out, McapOp::kMetadata);
  record.put_text(metadata.name);
  record.put_strings(metadata.values);
}

void append_record(McapBytes* out, const McapMetadataIndex& index) {
  McapRecordScope record(out, McapOp::kMetadataIndex);
  record.put_u64(index.offset);
  record.put_u64(index.length);
  record.put_text(index.name);
}

void append_record(McapBytes* out, const McapStatistics& statistics) {
  McapRecordScope record(out, McapOp::kStatistics);
  record.put_u64(statistics.messages);
  record.put_u16(statistics.schemas);
  record.put_u32(statistics.channels);
  record.put_u32(statistics.attachments);
  record.put_u32(statistics.metadata);
  record.put_u32(statistics.chunks);
  record.put_u64(statistics.start_time);
  record.put_u64(statistics.end_time);
  record.put_counts(statistics.channel_messages);
}

void append_record(McapBytes* out, const McapSummaryOffset& offset) {
  McapRecordScope record(out, McapOp::kSummaryOffset);
  record.put_u8(static_cast<uint8_t>(offset.op));
  record.put_u64(offset.start);
  record.put_u64(offset.length);
}

void append_footer(McapBytes* out, McapFooter footer, size_t summary_begin) {
  {
    McapRecordScope record(out, McapOp::kFooter);
    record.put_u64(footer.summary_start);
    record.put_u64(footer.summary_offset_start);
    record.put_u32(0);
  }
  // The CRC covers the footer's own opcode and length, which the scope has written by now.
  const std::span<const uint8_t> all(*out);
  const uint32_t crc = crc32_of(all.subspan(summary_begin, all.size() - 4 - summary_begin));
  for (size_t i = 0; i < 4; ++i) (*out)[out->size() - 4 + i] = static_cast<uint8_t>(crc >> (8 * i));
}

void append_data_end(McapBytes* out, uint32_t data_crc) {
  McapRecordScope record(out, McapOp::kDataEnd);
  record.put_u32(data_crc);
}

void append_message_index(McapBytes* out, uint16_t channel,
                          std::span<const std::pair<uint64_t, uint64_t>> entries) {
  McapRecordScope record(out, McapOp::kMessageIndex);
  record.put_u16(channel);
  record.put_u32(static_cast<uint32_t>(16 * entries.size()));
  for (const auto& [time, offset] : entries) {
    record.put_u64(time);
    record.put_u64(offset);
  }
}

}  // namespace gloam
