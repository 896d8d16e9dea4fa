#pragma once
// Repairs a truncated or damaged log: keeps all complete records with a correct CRC.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "mcap/log_source.h"
#include "mcap/mcap_limits.h"
#include "mcap/mcap_writer.h"

namespace gloam {

struct McapRecovery {
  bool whole = false;                                    ///< nothing was damaged
  uint64_t messages = 0, attachments = 0, metadata = 0;  ///< kept
  uint64_t chunks_lost = 0;
  /// From the log's statistics if its summary is there, else what message indexes tell, at least.
  uint64_t messages_lost = 0;
  bool counted = false;  ///< messages_lost is exact
  uint64_t bytes_lost = 0;
  std::vector<std::string> damage;  ///< "byte N: cause", the first 20
};

/// Writes the undamaged records of `source` to `writer`, in the order of the log, and finishes it.
/// Errors: no MCAP log, a disk. Where the writer's fails, its log is one to recover again.
Result<McapRecovery> recover_log(const LogSource& source, const McapLimits& limits,
                                 McapWriter* writer);

/// Writes the new file `to`; profile and library are those of the old log.
Result<McapRecovery> recover_log_file(const std::filesystem::path& from,
                                      const std::filesystem::path& to);

}  // namespace gloam
