#pragma once
// Contents of a log and their places: from its summary, or from a scan where no summary can be
// used.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "mcap/log_source.h"
#include "mcap/mcap_limits.h"
#include "mcap/mcap_records.h"

namespace gloam {

/// Piece of a log with messages: a chunk, or records that lie one behind the other outside chunks.
struct McapPiece {
  McapChunkIndex index;
  bool loose = false;  ///< not a chunk
};

struct McapCatalog {
  McapHeader header;
  std::map<uint16_t, McapSchema> schemas;
  std::map<uint16_t, McapChannel> channels;
  std::vector<McapPiece> pieces;  ///< in the order of the log
  std::vector<McapAttachmentIndex> attachments;
  std::vector<McapMetadataIndex> metadata;
  McapStatistics statistics;
  bool by_summary = false;
  std::string damage;  ///< first that a scan has met; empty = none, or not looked for
};

/// Summary section; nullopt where the log has none, or one that is damaged, or that leaves out what
/// readers need: statistics, an index of every chunk, a channel of every message. `why`: in words.
Result<std::optional<McapCatalog>> read_summary(const LogSource& source, const McapLimits& limits,
                                                std::string* why);

/// Reads the whole log.
Result<McapCatalog> scan_catalog(const LogSource& source, const McapLimits& limits);

/// Adds a definition, or says what is wrong with it. `bytes`: sum of what is held, kept by the
/// caller.
std::string add_definition(McapOp op, std::span<const uint8_t> content, const McapLimits& limits,
                           McapCatalog* catalog, uint64_t* bytes);

}  // namespace gloam
