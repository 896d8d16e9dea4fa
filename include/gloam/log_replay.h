#pragma once
// Logged runs looked at again: the same motion under another sky, with other cameras.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "gloam/result.h"
#include "gloam/run.h"

namespace gloam {

struct LogReplay {
  std::filesystem::path log;
  std::filesystem::path folder = {};  ///< where the scene's files are; empty = where they were
  int64_t run = 0;                    ///< number of resets before the run
  /// Options to change, as set_option takes them: weather, lights, materials, sky, cameras, LiDARs,
  /// smoke. Forces of what is changed do not act: bodies move as they did.
  std::vector<std::pair<std::string, std::string>> settings = {};
  std::vector<std::string> outputs = {};  ///< as of set_record_outputs; empty = the scene's
  RunRequest request = {};  ///< what is recorded, and where; a duration of 0 = the whole run
};

/// Steps the run again to the bit and records it as run_and_record() does. Errors: those of
/// verify_log and of run_and_record; a setting that would change how bodies move, by its name; a
/// run from a checkpoint or with a recompile.
Result<RunReport> replay_log(const LogReplay& replay, const ProgressCallback& progress);

}  // namespace gloam
