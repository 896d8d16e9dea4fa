#include "mcap/mcap_decode.h"

#include <utility>

#include "mcap/crc32.h"

namespace gloam {

uint64_t McapDecoder::number(unsigned size) {
  const std::span<const uint8_t> raw = bytes(size);
  uint64_t v = 0;
  for (size_t i = 0; i < raw.size(); ++i) v |= static_cast<uint64_t>(raw[i]) << (8 * i);
  return v;
}

std::span<const uint8_t> McapDecoder::bytes(uint64_t size) {
  if (!ok_ || size > left()) {
    ok_ = false;
    return {};
  }
  const std::span<const uint8_t> out = bytes_.subspan(position_, size);
  position_ += size;
  return out;
}

std::string McapDecoder::text() {
  const std::span<const uint8_t> raw = bytes(u32());
  return {reinterpret_cast<const char*>(raw.data()), raw.size()};
}

McapStrings McapDecoder::strings() {
  McapDecoder entries(bytes(u32()));
  McapStrings out;
  while (ok_ && entries.left() > 0) {
    std::string key = entries.text(), value = entries.text();
    ok_ = entries.ok();
    if (ok_) out.insert_or_assign(std::move(key), std::move(value));
  }
  return out;
}

McapCounts McapDecoder::counts() {
  McapDecoder entries(bytes(u32()));
  McapCounts out;
  while (ok_ && entries.left() > 0) {
    const uint16_t key = entries.u16();
    const uint64_t value = entries.u64();
    ok_ = entries.ok();
    if (ok_) out.emplace_back(key, value);
  }
  return out;
}

bool decode(std::span<const uint8_t> content, McapHeader* out) {
  McapDecoder in(content);
  *out = {in.text(), in.text()};
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapFooter* out) {
  McapDecoder in(content);
  *out = {in.u64(), in.u64(), in.u32()};
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapSchema* out) {
  McapDecoder in(content);
  out->id = in.u16();
  out->name = in.text();
  out->encoding = in.text();
  const std::span<const uint8_t> data = in.bytes(in.u32());
  out->data.assign(data.begin(), data.end());
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapChannel* out) {
  McapDecoder in(content);
  out->id = in.u16();
  out->schema = in.u16();
  out->topic = in.text();
  out->encoding = in.text();
  out->metadata = in.strings();
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapMessage* out) {
  McapDecoder in(content);
  out->channel = in.u16();
  out->sequence = in.u32();
  out->log_time = in.u64();
  out->publish_time = in.u64();
  out->data = in.bytes(in.left());
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapChunkHead* out) {
  McapDecoder in(content);
  out->start_time = in.u64();
  out->end_time = in.u64();
  out->uncompressed_size = in.u64();
  out->uncompressed_crc = in.u32();
  out->compression = in.text();
  out->records = in.bytes(in.u64());
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapChunkIndex* out) {
  McapDecoder in(content);
  out->start_time = in.u64();
  out->end_time = in.u64();
  out->offset = in.u64();
  out->length = in.u64();
  out->message_indexes = in.counts();
  out->message_index_length = in.u64();
  out->compression = in.text();
  out->compressed_size = in.u64();
  out->uncompressed_size = in.u64();
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapAttachment* out) {
  McapDecoder in(content);
  out->log_time = in.u64();
  out->create_time = in.u64();
  out->name = in.text();
  out->media_type = in.text();
  const std::span<const uint8_t> data = in.bytes(in.u64());
  const uint64_t covered = in.position();
  const uint32_t crc = in.u32();
  if (!in.ok() || (crc != 0 && crc != crc32_of(content.first(covered)))) return false;
  out->data.assign(data.begin(), data.end());
  return true;
}

bool decode(std::span<const uint8_t> content, McapAttachmentIndex* out) {
  McapDecoder in(content);
  out->offset = in.u64();
  out->length = in.u64();
  out->log_time = in.u64();
  out->create_time = in.u64();
  out->data_size = in.u64();
  out->name = in.text();
  out->media_type = in.text();
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapMetadata* out) {
  McapDecoder in(content);
  out->name = in.text();
  out->values = in.strings();
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapMetadataIndex* out) {
  McapDecoder in(content);
  out->offset = in.u64();
  out->length = in.u64();
  out->name = in.text();
  return in.ok();
}

bool decode(std::span<const uint8_t> content, McapStatistics* out) {
  McapDecoder in(content);
  out->messages = in.u64();
  out->schemas = in.u16();
  out->channels = in.u32();
  out->attachments = in.u32();
  out->metadata = in.u32();
  out->chunks = in.u32();
  out->start_time = in.u64();
  out->end_time = in.u64();
  out->channel_messages = in.counts();
  return in.ok();
}

bool McapRecordCursor::next() {
  McapDecoder in(bytes_.subspan(end_));
  const auto op = static_cast<McapOp>(in.u8());
  const std::span<const uint8_t> content = in.bytes(in.u64());
  if (!in.ok()) return false;
  op_ = op;
  content_ = content;
  offset_ = end_;
  end_ += in.position();
  return true;
}

}  // namespace gloam
