#pragma once
// Bytes of a stranger's log -> records. A decoder never reads beyond its bytes; contents may have
// fields after those known here, which later versions of the format add.

#include <cstdint>
#include <span>
#include <string>

#include "mcap/mcap_records.h"

namespace gloam {

/// Little-endian fields in order. What is asked for beyond the end is 0 or empty, and ok() is false
/// from then on.
class McapDecoder {
 public:
  explicit McapDecoder(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  uint64_t position() const { return position_; }
  uint64_t left() const { return bytes_.size() - position_; }
  uint8_t u8() { return static_cast<uint8_t>(number(1)); }
  uint16_t u16() { return static_cast<uint16_t>(number(2)); }
  uint32_t u32() { return static_cast<uint32_t>(number(4)); }
  uint64_t u64() { return number(8); }
  std::span<const uint8_t> bytes(uint64_t size);
  std::string text();
  McapStrings strings();
  McapCounts counts();

 private:
  uint64_t number(unsigned size);

  std::span<const uint8_t> bytes_;
  uint64_t position_ = 0;
  bool ok_ = true;
};

/// Each is false where the content is too short for what it declares.
bool decode(std::span<const uint8_t> content, McapHeader* out);
bool decode(std::span<const uint8_t> content, McapFooter* out);
bool decode(std::span<const uint8_t> content, McapSchema* out);
bool decode(std::span<const uint8_t> content, McapChannel* out);
/// The data stay in `content`; likewise the records of a chunk.
bool decode(std::span<const uint8_t> content, McapMessage* out);
bool decode(std::span<const uint8_t> content, McapChunkHead* out);
bool decode(std::span<const uint8_t> content, McapChunkIndex* out);
/// False also where the attachment has a CRC and it is another.
bool decode(std::span<const uint8_t> content, McapAttachment* out);
bool decode(std::span<const uint8_t> content, McapAttachmentIndex* out);
bool decode(std::span<const uint8_t> content, McapMetadata* out);
bool decode(std::span<const uint8_t> content, McapMetadataIndex* out);
bool decode(std::span<const uint8_t> content, McapStatistics* out);

/// One record after another in a piece of memory, such as a chunk or a summary.
class McapRecordCursor {
 public:
  explicit McapRecordCursor(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  /// False at the end and where what is left is no whole record.
  bool next();
  McapOp op() const { return op_; }
  std::span<const uint8_t> content() const { return content_; }
  /// Where the present record begins [bytes].
  uint64_t offset() const { return offset_; }
  /// True when all bytes were whole records; for after next() was false.
  bool whole() const { return end_ == bytes_.size(); }

 private:
  std::span<const uint8_t> bytes_, content_;
  McapOp op_ = McapOp::kHeader;
  uint64_t offset_ = 0, end_ = 0;
};

}  // namespace gloam
