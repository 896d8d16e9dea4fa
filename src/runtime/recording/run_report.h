#pragma once
// Results of a recorded run: for its recorder, which writes them into summary.json, and its caller.

#include <filesystem>
#include <string>
#include <vector>

#include "gloam/run.h"
#include "metrics/metrics.h"
#include "record/recorder.h"

namespace gloam {

/// Wall times [s] since the start of the run.
struct RunTimes {
  double prepared = 0;   ///< when the recorder and its streams were open
  double simulated = 0;  ///< when the last step was taken
  double drained = 0;    ///< when the streams had ended
};

/// End of the run and results: first of the metrics, then of `sensing`.
RunOutcome run_outcome(const RunReport& report, const RunTimes& times, const Metrics& metrics,
                       const std::vector<NamedNumber>& sensing);

/// Files of a results folder that are worth naming to its user.
std::vector<std::string> main_files(const std::filesystem::path& folder);

}  // namespace gloam
