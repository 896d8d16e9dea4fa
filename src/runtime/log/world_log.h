#pragma once
// WorldLog: writes into a log the Worlds that a simulation runs in, with their files if asked for.

#include <set>
#include <string>

#include "gloam/log.h"
#include "runtime/live/live_simulation.h"
#include "runtime/log/log_channels.h"
#include "runtime/log/run_text.h"

namespace gloam {

/// Place in a log from which a simulation is in a World.
struct WorldStart {
  int64_t run = 0, step = 0;
  bool has_history = false;  ///< RunText::has_history
};

class WorldLog {
 public:
  /// The arguments must outlive this object.
  WorldLog(const LogRequest& request, LogChannels& channels, LiveSimulation& simulation)
      : request_(request), channels_(channels), simulation_(simulation) {}

  /// Error: a file that is to be embedded cannot be read.
  Status write(const CompiledWorld& world, const WorldStart& start, uint64_t log_time);

 private:
  Status embed(const DescribedRun& run);

  const LogRequest& request_;
  LogChannels& channels_;
  LiveSimulation& simulation_;
  std::set<std::string> embedded_;  // names of files that are in the log
};

}  // namespace gloam
