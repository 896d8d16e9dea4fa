#pragma once
// Reader of MCAP logs of any writer. A log may come from a stranger: no length or offset in it is
// believed before it is compared with the file, no size before it is compared with McapLimits.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "mcap/log_source.h"
#include "mcap/mcap_catalog.h"
#include "mcap/mcap_messages.h"

namespace gloam {

class McapReader {
 public:
  /// By the summary where there is one, else by a scan of the whole log. A log that is cut or
  /// damaged opens with what is whole in it; damage() then tells. Errors: no MCAP log, the disk.
  static Result<McapReader> open(const std::filesystem::path& path, const McapLimits& limits = {});
  static Result<McapReader> open(std::shared_ptr<const LogSource> source,
                                 const McapLimits& limits = {});

  const std::string& name() const { return source_->name(); }
  uint64_t size() const { return source_->size(); }  ///< [bytes]
  const McapHeader& header() const { return catalog_->header; }
  const std::map<uint16_t, McapSchema>& schemas() const { return catalog_->schemas; }
  const std::map<uint16_t, McapChannel>& channels() const { return catalog_->channels; }
  const std::vector<McapPiece>& pieces() const { return catalog_->pieces; }
  const McapStatistics& statistics() const { return catalog_->statistics; }
  const std::vector<McapAttachmentIndex>& attachments() const { return catalog_->attachments; }
  const std::vector<McapMetadataIndex>& metadata() const { return catalog_->metadata; }
  bool by_summary() const { return catalog_->by_summary; }
  /// First damage that a scan has met; by the summary it is found when its chunk is read.
  const std::string& damage() const { return catalog_->damage; }

  /// Messages in the order of log time; may outlive the reader's moves, not its end.
  McapMessages messages(const McapQuery& query = {}) const;
  Result<McapAttachment> read_attachment(const McapAttachmentIndex& index) const;
  Result<McapMetadata> read_metadata(const McapMetadataIndex& index) const;

 private:
  McapReader(std::shared_ptr<const LogSource> source, const McapLimits& limits, McapCatalog catalog)
      : source_(std::move(source)),
        limits_(limits),
        catalog_(std::make_unique<McapCatalog>(std::move(catalog))) {}

  std::shared_ptr<const LogSource> source_;
  McapLimits limits_;
  std::unique_ptr<const McapCatalog> catalog_;  // at one place, for McapMessages
};

/// Content of the record at `offset`, of `length` bytes in all, if it is a `op` of at most `most`.
Result<std::vector<uint8_t>> read_record(const LogSource& source, McapOp op, uint64_t offset,
                                         uint64_t length, uint64_t most);

}  // namespace gloam
