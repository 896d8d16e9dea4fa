#include <algorithm>

#include "mcap/crc32.h"
#include "mcap/mcap_catalog.h"
#include "mcap/mcap_decode.h"
#include "mcap/mcap_scan.h"

namespace gloam {
namespace {

/// Reads the footer and the bytes of the summary; what is wrong, or "".
Result<std::string> load_summary(const LogSource& source, const McapLimits& limits,
                                 uint64_t data_begin, std::vector<uint8_t>* summary) {
  constexpr uint64_t kTrailerSize = kMcapRecordHead + kMcapFooterContent + kMcapMagic.size();
  if (source.size() < data_begin + kTrailerSize) return std::string("the log has no footer");
  const uint64_t footer_at = source.size() - kTrailerSize;
  std::vector<uint8_t> tail(kTrailerSize);
  GLOAM_TRY_STATUS(source.read(footer_at, tail));
  McapRecordCursor cursor(std::span<const uint8_t>(tail).first(kTrailerSize - kMcapMagic.size()));
  McapFooter footer;
  if (!std::equal(kMcapMagic.begin(), kMcapMagic.end(), tail.end() - kMcapMagic.size()) ||
      !cursor.next() || cursor.op() != McapOp::kFooter || !decode(cursor.content(), &footer))
    return std::string("the log has no footer");
  if (footer.summary_start == 0) return std::string("the log has no summary");
  if (footer.summary_start < data_begin || footer.summary_start > footer_at)
    return std::string("the summary is outside the log");
  if (footer_at - footer.summary_start > limits.summary_bytes)
    return std::string("the summary is too large");
  summary->resize(footer_at - footer.summary_start);
  GLOAM_TRY_STATUS(source.read(footer.summary_start, *summary));
  const auto covered = std::span<const uint8_t>(tail).first(kMcapRecordHead + 16);
  if (footer.summary_crc != 0 && footer.summary_crc != crc32_of(covered, crc32_of(*summary)))
    return std::string("the CRC of the summary is wrong");
  return std::string();
}

template <class T>
bool decode_into(std::span<const uint8_t> content, std::vector<T>* out) {
  out->emplace_back();
  return decode(content, &out->back());
}

struct SummaryParts {
  McapCatalog catalog;
  bool has_statistics = false;
  uint64_t definition_bytes = 0;
};

/// One record of the summary; what is wrong, or "".
std::string take_record(const McapRecordCursor& cursor, const McapLimits& limits,
                        SummaryParts* parts) {
  McapCatalog& catalog = parts->catalog;
  bool fine = true;
  switch (cursor.op()) {
    case McapOp::kSchema:
    case McapOp::kChannel:
      return add_definition(cursor.op(), cursor.content(), limits, &catalog,
                            &parts->definition_bytes);
    case McapOp::kStatistics:
      parts->has_statistics = true;
      fine = decode(cursor.content(), &catalog.statistics);
      break;
    case McapOp::kChunkIndex:
      catalog.pieces.emplace_back();
      fine = decode(cursor.content(), &catalog.pieces.back().index);
      break;
    case McapOp::kAttachmentIndex:
      fine = decode_into(cursor.content(), &catalog.attachments);
      break;
    case McapOp::kMetadataIndex:
      fine = decode_into(cursor.content(), &catalog.metadata);
      break;
    default:
      break;  // summary offsets, and what later versions add
  }
  return fine ? std::string() : "a record of the summary is damaged";
}

/// Reason why the summary cannot be used alone, or "".
std::string find_gap(const SummaryParts& parts, uint64_t log_bytes) {
  const McapCatalog& catalog = parts.catalog;
  const McapStatistics& counts = catalog.statistics;
  if (!parts.has_statistics) return "the summary has no statistics";
  if (catalog.pieces.size() != counts.chunks || (catalog.pieces.empty() && counts.messages > 0))
    return "the summary has no index of the chunks";
  if (catalog.channels.size() != counts.channels || catalog.schemas.size() != counts.schemas)
    return "the summary omits schemas or channels";
  if (catalog.attachments.size() != counts.attachments ||
      catalog.metadata.size() != counts.metadata)
    return "the summary has no index of the attachments or metadata";
  uint64_t end = 0;
  for (const McapPiece& piece : catalog.pieces) {
    const McapChunkIndex& index = piece.index;
    if (index.offset < end || index.offset > log_bytes || index.length > log_bytes - index.offset)
      return "the summary lists chunks that overlap or are outside the log";
    end = index.offset + index.length;
    for (const auto& [channel, offset] : index.message_indexes)
      if (!catalog.channels.contains(channel)) return "the summary omits channels";
  }
  return {};
}

}  // namespace

std::string add_definition(McapOp op, std::span<const uint8_t> content, const McapLimits& limits,
                           McapCatalog* catalog, uint64_t* bytes) {
  const auto add = [&]<class T>(T record, std::map<uint16_t, T>* all) -> std::string {
    if (!decode(content, &record)) return "a schema or channel is shorter than it declares";
    if (const auto known = all->find(record.id); known != all->end())
      return known->second == record
                 ? ""
                 : "a schema or channel is declared twice with different contents";
    *bytes += content.size() + sizeof(T);
    if (*bytes > limits.definition_bytes)
      return "there are too many schemas and channels, or they are too large";
    all->emplace(record.id, std::move(record));
    return "";
  };
  if (content.size() > limits.definition_bytes) return "a schema or channel is too large";
  return op == McapOp::kSchema ? add(McapSchema(), &catalog->schemas)
                               : add(McapChannel(), &catalog->channels);
}

Result<std::optional<McapCatalog>> read_summary(const LogSource& source, const McapLimits& limits,
                                                std::string* why) {
  SummaryParts parts;
  uint64_t data_begin = 0;
  GLOAM_TRY(parts.catalog.header, read_header(source, &data_begin));
  std::vector<uint8_t> summary;
  GLOAM_TRY(*why, load_summary(source, limits, data_begin, &summary));
  if (!why->empty()) return std::optional<McapCatalog>();
  McapRecordCursor cursor(summary);
  while (why->empty() && cursor.next()) *why = take_record(cursor, limits, &parts);
  if (why->empty() && !cursor.whole()) *why = "a record of the summary is damaged";
  if (!why->empty()) return std::optional<McapCatalog>();
  std::sort(parts.catalog.pieces.begin(), parts.catalog.pieces.end(),
            [](const McapPiece& a, const McapPiece& b) { return a.index.offset < b.index.offset; });
  *why = find_gap(parts, source.size());
  if (!why->empty()) return std::optional<McapCatalog>();
  parts.catalog.by_summary = true;
  return std::optional<McapCatalog>(std::move(parts.catalog));
}

}  // namespace gloam
