#pragma once
// World of a replay: that of the log, changed as the replay asks.

#include "gloam/log_replay.h"
#include "runtime/log/logged_runs.h"

namespace gloam {

/// The World that the run is seen in. Errors: those of overlay_scene, set_option and the compiler;
/// but for kNewRun the overlay or setting that would change how bodies move.
Result<World> compile_replay(const LogReplay& replay, const LoggedRuns::Run& run);

}  // namespace gloam
