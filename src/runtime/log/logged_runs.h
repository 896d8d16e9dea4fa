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
    int64_t first_step = -1, last_step = 0;  ///< of states that were logged
    bool has_beginning = false;              ///< its Commands are logged from its initial state on
    /// Part of it was before the log, which lacks what step hooks and logged controllers did then.
    bool has_history = false;
    int64_t number = 0;  ///< resets and checkpoints before it, in the simulation
    Status same_bits;    ///< why it cannot be stepped again to the bit, if so
  };
  std::map<int64_t, Run> runs;  ///< by number

  /// Reads Worlds, which are compiled, Commands and the steps of states. `folder`: compile_run's.
  /// Commands of a run that cannot be stepped again to the bit are left out. Errors: a log without
  /// a run, compile_run's, the log's.
  static Result<LoggedRuns> read(const McapReader& log, const std::filesystem::path& folder);
  /// The log's run at `place`, from 0. Error: there are fewer.
  Result<const Run*> find(int64_t place) const;
};

}  // namespace gloam
