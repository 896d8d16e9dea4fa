#include "mcap/mcap_reader.h"

#include <fmt/format.h>

#include <utility>

#include "base/formats/foreign_format.h"
#include "base/memory.h"
#include "mcap/mcap_decode.h"

namespace gloam {

Result<McapReader> McapReader::open(const std::filesystem::path& path, const McapLimits& limits) {
  GLOAM_TRY_STATUS(refuse_foreign_format(path));
  GLOAM_TRY(std::shared_ptr<const LogSource> source, open_log_file(path));
  return open(std::move(source), limits);
}

Result<McapReader> McapReader::open(std::shared_ptr<const LogSource> source,
                                    const McapLimits& limits) {
  std::string why;
  GLOAM_TRY(std::optional<McapCatalog> summary, read_summary(*source, limits, &why));
  if (summary) return McapReader(std::move(source), limits, std::move(*summary));
  GLOAM_TRY(McapCatalog scanned, scan_catalog(*source, limits));
  return McapReader(std::move(source), limits, std::move(scanned));
}

McapMessages McapReader::messages(const McapQuery& query) const {
  return McapMessages(source_, catalog_.get(), limits_, query);
}

Result<std::vector<uint8_t>> read_record(const LogSource& source, McapOp op, uint64_t offset,
                                         uint64_t length, uint64_t most) {
  if (length < kMcapRecordHead || offset > source.size() || length > source.size() - offset)
    return mcap_error(source, offset,
                      fmt::format("a record of {} bytes is outside the log", length));
  if (length > most)
    return mcap_error(source, offset,
                      fmt::format("a record has {} bytes; the limit is {}", length, most));
  GLOAM_TRY_STATUS(check_memory(length, "a record of " + source.name(), "free some memory"));
  std::vector<uint8_t> bytes(length);
  GLOAM_TRY_STATUS(source.read(offset, bytes));
  McapRecordCursor cursor(bytes);
  if (!cursor.next() || cursor.op() != op)
    return mcap_error(source, offset, "the record does not match the index");
  bytes.erase(bytes.begin(), bytes.begin() + kMcapRecordHead);
  return bytes;
}

Result<McapAttachment> McapReader::read_attachment(const McapAttachmentIndex& index) const {
  GLOAM_TRY(const auto content, read_record(*source_, McapOp::kAttachment, index.offset,
                                            index.length, limits_.attachment_bytes));
  McapAttachment attachment;
  if (!decode(content, &attachment))
    return mcap_error(*source_, index.offset, "an attachment is too short or has a wrong CRC");
  return attachment;
}

Result<McapMetadata> McapReader::read_metadata(const McapMetadataIndex& index) const {
  GLOAM_TRY(const auto content, read_record(*source_, McapOp::kMetadata, index.offset, index.length,
                                            limits_.definition_bytes));
  McapMetadata metadata;
  if (!decode(content, &metadata))
    return mcap_error(*source_, index.offset, "a metadata record is too short");
  return metadata;
}

}  // namespace gloam
