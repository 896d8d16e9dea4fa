#pragma once
// A log as a tree of its records, for tests that damage it: lengths, CRCs, indexes and the summary
// are made when it is written, so that damage gets behind the checks of the container.

#include <algorithm>
#include <string>
#include <vector>

#include "mcap/compression.h"
#include "mcap/crc32.h"
#include "mcap/mcap_decode.h"
#include "mcap/mcap_encode.h"

namespace gloam {

struct McapTreeRecord {
  McapOp op = McapOp::kHeader;
  McapBytes content;
  std::vector<McapTreeRecord> inside = {};  ///< of a chunk
  std::string compression = {};
};
using McapTree = std::vector<McapTreeRecord>;

inline bool is_derived(McapOp op) {
  return op == McapOp::kFooter || op == McapOp::kMessageIndex || op == McapOp::kChunkIndex ||
         op == McapOp::kAttachmentIndex || op == McapOp::kMetadataIndex ||
         op == McapOp::kSummaryOffset || op == McapOp::kStatistics;
}

/// Data records up to the end of the data section, from behind the magic on.
inline McapTree read_mcap_tree(std::span<const uint8_t> bytes) {
  McapTree out;
  McapRecordCursor cursor(bytes);
  while (cursor.next() && cursor.op() != McapOp::kDataEnd) {
    if (is_derived(cursor.op())) continue;
    McapTreeRecord record{cursor.op(), {cursor.content().begin(), cursor.content().end()}};
    McapChunkHead head;
    constexpr uint64_t kLargest = 1 << 20;
    if (record.op == McapOp::kChunk && decode(record.content, &head) &&
        head.uncompressed_size <= kLargest) {
      McapBytes plain(head.uncompressed_size);
      if (!decompress(head.compression, head.records, plain).empty()) continue;
      record.inside = read_mcap_tree(plain);
      record.compression = head.compression;
    }
    out.push_back(std::move(record));
  }
  return out;
}

class McapTreeWriter {
 public:
  McapBytes write(const McapTree& records, bool has_summary) {
    append_magic(&out_);
    for (const McapTreeRecord& record : records) {
      declare(record);
      if (record.op == McapOp::kChunk && !record.inside.empty())
        append_chunk(record);
      else
        append_data(record);
    }
    for (const McapChunkIndex& chunk : chunks_) append_record(&summary_, chunk);
    statistics_.chunks = static_cast<uint32_t>(chunks_.size());
    append_record(&summary_, statistics_);
    append_data_end(&out_, 0);
    const size_t begin = out_.size();
    if (has_summary) out_.insert(out_.end(), summary_.begin(), summary_.end());
    append_footer(&out_, {.summary_start = has_summary ? begin : 0}, begin);
    append_magic(&out_);
    return std::move(out_);
  }

 private:
  static void append(const McapTreeRecord& record, McapBytes* out) {
    McapRecordScope scope(out, record.op);
    const std::span<const uint8_t> content(record.content);
    if (record.op != McapOp::kAttachment || content.size() < 4) return scope.put_bytes(content);
    scope.put_bytes(content.first(content.size() - 4));
    scope.put_u32(crc32_of(content.first(content.size() - 4)));
  }

  void declare(const McapTreeRecord& record) {
    if (record.op == McapOp::kSchema || record.op == McapOp::kChannel) append(record, &summary_);
    statistics_.schemas += record.op == McapOp::kSchema ? 1 : 0;
    statistics_.channels += record.op == McapOp::kChannel ? 1 : 0;
    statistics_.messages += record.op == McapOp::kMessage ? 1 : 0;
    for (const McapTreeRecord& inner : record.inside) declare(inner);
  }

  void append_data(const McapTreeRecord& record) {
    const uint64_t offset = out_.size();
    append(record, &out_);
    const uint64_t length = out_.size() - offset;
    const std::span<const uint8_t> content =
        std::span<const uint8_t>(out_).subspan(offset + kMcapRecordHead);
    McapAttachment attachment;
    McapMetadata metadata;
    if (record.op == McapOp::kAttachment && decode(content, &attachment)) {
      append_record(&summary_, McapAttachmentIndex{offset, length, attachment.log_time,
                                                   attachment.create_time, attachment.data.size(),
                                                   attachment.name, attachment.media_type});
      ++statistics_.attachments;
    }
    if (record.op == McapOp::kMetadata && decode(content, &metadata)) {
      append_record(&summary_, McapMetadataIndex{offset, length, metadata.name});
      ++statistics_.metadata;
    }
  }

  void append_chunk(const McapTreeRecord& chunk) {
    McapBytes plain, packed;
    McapChunkIndex index;
    index.start_time = ~uint64_t{0};
    for (const McapTreeRecord& record : chunk.inside) {
      append(record, &plain);
      McapMessage message;
      if (record.op != McapOp::kMessage || !decode(record.content, &message)) continue;
      index.start_time = std::min(index.start_time, message.log_time);
      index.end_time = std::max(index.end_time, message.log_time);
    }
    if (index.start_time > index.end_time) index.start_time = 0;
    statistics_.end_time = std::max(statistics_.end_time, index.end_time);
    index.compression = chunk.compression == "zstd" ? "zstd" : "";
    if (index.compression.empty())
      packed = plain;
    else if (!ZstdCompressor(1).append(plain, 2 * plain.size() + 1024, &packed))
      return;
    index.offset = out_.size();
    {
      McapRecordScope scope(&out_, McapOp::kChunk);
      scope.put_u64(index.start_time);
      scope.put_u64(index.end_time);
      scope.put_u64(plain.size());
      scope.put_u32(crc32_of(plain));
      scope.put_text(index.compression);
      scope.put_u64(packed.size());
      scope.put_bytes(packed);
    }
    index.length = out_.size() - index.offset;
    index.compressed_size = packed.size();
    index.uncompressed_size = plain.size();
    chunks_.push_back(index);
  }

  McapBytes out_, summary_;
  McapStatistics statistics_;
  std::vector<McapChunkIndex> chunks_;
};

}  // namespace gloam
