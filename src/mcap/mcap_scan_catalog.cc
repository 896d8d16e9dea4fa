#include <fmt/format.h>

#include <algorithm>

#include "mcap/mcap_catalog.h"
#include "mcap/mcap_decode.h"
#include "mcap/mcap_scan.h"

namespace gloam {
namespace {

constexpr uint64_t kLoosePiece = 4 << 20;  // [bytes]; a larger message is a piece of its own
constexpr uint64_t kAttachmentFront = 64 * 1024;

class CatalogBuilder final : public McapVisitor {
 public:
  CatalogBuilder(const LogSource& source, const McapLimits& limits)
      : source_(source), limits_(limits) {}

  Status visit_chunk(const McapRecordPlace& place, const McapChunkHead& head,
                     std::span<const uint8_t> records) override {
    loose_open_ = false;
    McapPiece piece;
    piece.index.offset = place.offset;
    piece.index.length = place.length;
    piece.index.compression = head.compression;
    piece.index.compressed_size = head.records.size();
    piece.index.uncompressed_size = head.uncompressed_size;
    McapRecordCursor cursor(records);
    uint64_t messages = 0;
    while (cursor.next()) {
      if (cursor.op() == McapOp::kMessage)
        count_message(cursor.content(), messages++ == 0, &piece.index);
      else
        define(cursor.op(), place.offset, cursor.content());
    }
    ++catalog_.statistics.chunks;
    catalog_.pieces.push_back(std::move(piece));
    return {};
  }

  Status visit_record(const McapRecordPlace& place, std::span<const uint8_t> content) override {
    if (place.op == McapOp::kMessage) return loose_message(place, content);
    if (place.op == McapOp::kMetadata) {
      McapMetadata metadata;
      if (content.size() <= limits_.definition_bytes && decode(content, &metadata)) {
        catalog_.metadata.push_back({place.offset, place.length, std::move(metadata.name)});
        ++catalog_.statistics.metadata;
      } else {
        visit_damage(place, "a metadata record is damaged");
      }
    }
    define(place.op, place.offset, content);
    loose_open_ = false;
    return {};
  }

  Status visit_attachment(const McapRecordPlace& place) override {
    loose_open_ = false;
    std::vector<uint8_t> front(
        std::min<uint64_t>(place.length - kMcapRecordHead, kAttachmentFront));
    GLOAM_TRY_STATUS(source_.read(place.offset + kMcapRecordHead, front));
    McapDecoder in(front);
    McapAttachmentIndex index{place.offset, place.length, in.u64(), in.u64(), 0, {}, {}};
    index.name = in.text();
    index.media_type = in.text();
    index.data_size = in.u64();
    if (in.ok()) {
      catalog_.attachments.push_back(std::move(index));
      ++catalog_.statistics.attachments;
    } else {
      visit_damage(place, "an attachment is damaged");
    }
    return {};
  }

  void visit_damage(const McapRecordPlace& place, const std::string& cause) override {
    if (catalog_.damage.empty()) catalog_.damage = fmt::format("byte {}: {}", place.offset, cause);
  }

  McapCatalog take() {
    McapStatistics& counts = catalog_.statistics;
    counts.schemas = static_cast<uint16_t>(catalog_.schemas.size());
    counts.channels = static_cast<uint32_t>(catalog_.channels.size());
    counts.channel_messages.assign(messages_.begin(), messages_.end());
    return std::move(catalog_);
  }

 private:
  void define(McapOp op, uint64_t offset, std::span<const uint8_t> content) {
    if (op != McapOp::kSchema && op != McapOp::kChannel) return;
    const std::string wrong = add_definition(op, content, limits_, &catalog_, &definition_bytes_);
    if (!wrong.empty()) visit_damage({op, offset, 0}, wrong);
  }

  void count_message(std::span<const uint8_t> content, bool first, McapChunkIndex* index) {
    McapMessage message;
    if (!decode(content, &message)) return;
    const uint64_t time = message.log_time;
    index->start_time = first ? time : std::min(index->start_time, time);
    index->end_time = first ? time : std::max(index->end_time, time);
    McapStatistics& counts = catalog_.statistics;
    counts.start_time = counts.messages == 0 ? time : std::min(counts.start_time, time);
    counts.end_time = std::max(counts.end_time, time);
    ++counts.messages;
    ++messages_[message.channel];
  }

  Status loose_message(const McapRecordPlace& place, std::span<const uint8_t> content) {
    McapMessage message;
    if (!decode(content, &message)) {
      visit_damage(place, "a message is too short");
      loose_open_ = false;
      return {};
    }
    const bool first =
        !loose_open_ || catalog_.pieces.back().index.length + place.length > kLoosePiece;
    if (first) {
      catalog_.pieces.push_back({{}, true});
      catalog_.pieces.back().index.offset = place.offset;
      loose_open_ = true;
    }
    McapChunkIndex& index = catalog_.pieces.back().index;
    count_message(content, first, &index);
    index.length += place.length;
    index.uncompressed_size = index.compressed_size = index.length;
    return {};
  }

  const LogSource& source_;
  const McapLimits& limits_;
  McapCatalog catalog_;
  std::map<uint16_t, uint64_t> messages_;
  uint64_t definition_bytes_ = 0;
  bool loose_open_ = false;  // the last piece takes further messages outside chunks
};

}  // namespace

Result<McapCatalog> scan_catalog(const LogSource& source, const McapLimits& limits) {
  CatalogBuilder builder(source, limits);
  GLOAM_TRY(const McapScanResult scanned, scan_log(source, limits, {}, &builder));
  McapCatalog catalog = builder.take();
  catalog.header = scanned.header;
  return catalog;
}

}  // namespace gloam
