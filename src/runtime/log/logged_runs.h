#pragma once
// LoggedRuns: the runs of a log, ready to be stepped again.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mcap/mcap_reader.h"
#include "sim/loop/run_record.h"

namespace gloam {

struct LoggedRuns {
  struct Run {
    RunRecord record;
    int64_t last_step = 0;     ///< of the last state that was logged
    bool begins_anew = false;  ///< at its initial state: not from a checkpoint
  };
  std::map<int64_t, Run> runs;  ///< by number of resets

  /// Reads Worlds, which are compiled, Commands and the steps of states. `folder`: compile_run's.
  /// Errors: a log without a run, compile_run's, the log's.
  static Result<LoggedRuns> read(const McapReader& log, const std::filesystem::path& folder);
};

}  // namespace gloam
