#include "mcap/mcap_recover.h"

#include <fmt/format.h>

#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/formats/foreign_format.h"
#include "mcap/log_sink.h"
#include "mcap/mcap_catalog.h"
#include "mcap/mcap_decode.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_scan.h"

namespace gloam {
namespace {

constexpr size_t kMostDamage = 20;

class Salvage final : public McapVisitor {
 public:
  /// `summary`: of the damaged log, if it is there: channels whose own record is lost.
  Salvage(const LogSource& source, const McapLimits& limits, const McapCatalog* summary,
          McapWriter* writer)
      : source_(source), limits_(limits), summary_(summary), writer_(writer) {}

  Status visit_chunk(const McapRecordPlace& place, const McapChunkHead&,
                     std::span<const uint8_t> records) override {
    after_lost_chunk_ = false;
    McapRecordCursor cursor(records);
    while (cursor.next()) GLOAM_TRY_STATUS(keep(cursor.op(), place.offset, cursor.content()));
    return {};
  }

  Status visit_record(const McapRecordPlace& place, std::span<const uint8_t> content) override {
    if (place.op == McapOp::kMessageIndex) {
      if (after_lost_chunk_ && content.size() > 6)
        found_.messages_lost += (content.size() - 6) / 16;
      return {};
    }
    after_lost_chunk_ = false;
    return keep(place.op, place.offset, content);
  }

  Status visit_attachment(const McapRecordPlace& place) override {
    after_lost_chunk_ = false;
    Result<std::vector<uint8_t>> content = read_record(source_, McapOp::kAttachment, place.offset,
                                                       place.length, limits_.attachment_bytes);
    if (!content && content.error().kind == ErrorKind::kIo) return std::move(content).error();
    McapAttachment attachment;
    if (!content || !decode(*content, &attachment)) {
      visit_damage(place, "an attachment is incomplete or too large");
      return {};
    }
    ++found_.attachments;
    return writer_->add_attachment(attachment);
  }

  void visit_damage(const McapRecordPlace& place, const std::string& cause) override {
    found_.bytes_lost += place.length;
    after_lost_chunk_ = place.op == McapOp::kChunk;
    if (after_lost_chunk_) ++found_.chunks_lost;
    damaged_ = true;
    if (found_.damage.size() < kMostDamage)
      found_.damage.push_back(fmt::format("byte {}: {}", place.offset, cause));
  }

  /// Channels without messages, too.
  Status declare_rest() {
    for (const auto& [id, channel] : known_.channels) GLOAM_TRY_STATUS(declare(channel));
    return {};
  }

  McapRecovery take(bool whole) {
    found_.whole = whole && !damaged_;
    if (summary_ != nullptr && summary_->statistics.messages >= found_.messages) {
      found_.messages_lost = summary_->statistics.messages - found_.messages;
      found_.counted = true;
    }
    return std::move(found_);
  }

 private:
  Status keep(McapOp op, uint64_t offset, std::span<const uint8_t> content) {
    switch (op) {
      case McapOp::kSchema:
      case McapOp::kChannel: {
        const std::string wrong = add_definition(op, content, limits_, &known_, &known_bytes_);
        if (!wrong.empty()) visit_damage({op, offset, 0}, wrong);
        return {};
      }
      case McapOp::kMessage:
        return keep_message(offset, content);
      case McapOp::kMetadata: {
        McapMetadata metadata;
        if (content.size() > limits_.definition_bytes || !decode(content, &metadata)) {
          visit_damage({op, offset, content.size()}, "a metadata record is incomplete");
          return {};
        }
        ++found_.metadata;
        return writer_->add_metadata(metadata);
      }
      default:
        return op >= McapOp::kFirstPrivate ? writer_->add_private(op, content) : Status();
    }
  }

  Status keep_message(uint64_t offset, std::span<const uint8_t> content) {
    McapMessage message;
    if (!decode(content, &message) || message.data.size() > kMcapLargestMessage) {
      visit_damage({McapOp::kMessage, offset, content.size()}, "a message has a wrong size");
      return {};
    }
    if (!declared_.contains(message.channel)) {
      const McapChannel* channel = find(&McapCatalog::channels, message.channel);
      if (channel == nullptr) {
        ++found_.messages_lost;
        visit_damage(
            {McapOp::kMessage, offset, kMcapRecordHead + content.size()},
            fmt::format("messages of channel {}, whose definition is lost", message.channel));
        return {};
      }
      GLOAM_TRY_STATUS(declare(*channel));
    }
    ++found_.messages;
    return writer_->add_message(message);
  }

  template <class T>
  const T* find(std::map<uint16_t, T> McapCatalog::* all, uint16_t id) const {
    const std::initializer_list<const McapCatalog*> catalogs = {&known_, summary_};
    for (const McapCatalog* in : catalogs) {
      if (in == nullptr) continue;
      if (const auto found = (in->*all).find(id); found != (in->*all).end()) return &found->second;
    }
    return nullptr;
  }

  /// A channel whose schema is lost is kept without one.
  Status declare(McapChannel channel) {
    if (!declared_.insert(channel.id).second) return {};
    const McapSchema* schema =
        channel.schema == 0 ? nullptr : find(&McapCatalog::schemas, channel.schema);
    if (schema != nullptr && schema->id != 0) {
      if (declared_schemas_.insert(schema->id).second)
        GLOAM_TRY_STATUS(writer_->add_schema(*schema));
    } else {
      channel.schema = 0;
    }
    return writer_->add_channel(channel);
  }

  const LogSource& source_;
  const McapLimits& limits_;
  const McapCatalog* summary_;
  McapWriter* writer_;
  McapCatalog known_;  // definitions met so far
  uint64_t known_bytes_ = 0;
  std::set<uint16_t> declared_, declared_schemas_;  // in the new log
  McapRecovery found_;
  bool after_lost_chunk_ = false, damaged_ = false;
};

}  // namespace

Result<McapRecovery> recover_log(const LogSource& source, const McapLimits& limits,
                                 McapWriter* writer) {
  std::string why;
  GLOAM_TRY(const std::optional<McapCatalog> summary, read_summary(source, limits, &why));
  std::vector<uint64_t> chunks;
  if (summary)
    for (const McapPiece& piece : summary->pieces) chunks.push_back(piece.index.offset);
  Salvage salvage(source, limits, summary ? &*summary : nullptr, writer);
  GLOAM_TRY(const McapScanResult scanned, scan_log(source, limits, chunks, &salvage));
  GLOAM_TRY_STATUS(salvage.declare_rest());
  GLOAM_TRY_STATUS(writer->finish());
  return salvage.take(scanned.whole);
}

Result<McapRecovery> recover_log_file(const std::filesystem::path& from,
                                      const std::filesystem::path& to) {
  GLOAM_TRY_STATUS(refuse_foreign_format(from));
  GLOAM_TRY(const std::shared_ptr<const LogSource> source, open_log_file(from));
  uint64_t begin = 0;
  GLOAM_TRY(const McapHeader header, read_header(*source, &begin));
  GLOAM_TRY(std::unique_ptr<LogSink> sink, FileSink::create(to));
  McapWriterOptions options;
  options.profile = header.profile;
  options.library = header.library;
  McapWriter writer(std::move(sink), std::move(options));
  return recover_log(*source, McapLimits(), &writer);
}

}  // namespace gloam
