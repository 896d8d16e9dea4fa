#pragma once
// Results folders, as runs and replays leave them, and which of them belong together.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "gloam/result.h"
#include "report/metric_table.h"

namespace gloam {

struct RunResults {
  struct Camera {
    std::string name, folder;
    int64_t frames = 0;
  };
  using Texts = std::vector<std::pair<std::string, std::string>>;
  using Numbers = std::vector<std::pair<std::string, double>>;

  std::filesystem::path folder;
  std::string label;  ///< of the folder, unique in a report
  int color = 0;
  std::string title, state, exit_reason, scene_file, scene_hash, seed, final_hash;
  Texts versions, settings, drawn;
  double simulated = 0, planned = 0;  ///< [s]
  int64_t steps = 0;
  Numbers results, timings;
  std::vector<Camera> cameras;
  MetricTable metrics;

  bool is_finished() const { return state == "finished" && exit_reason == "completed"; }
  /// Number of the results of that name; NaN = none.
  double result(const std::string& name) const;
};

/// Reads summary.json and metrics.csv. A table that is damaged is added to `problems`. Errors: no
/// folder, no summary of Gloam's.
Result<RunResults> read_run_results(const std::filesystem::path& folder,
                                    std::vector<Error>* problems);
/// Labels from the ends of the paths, as long as it takes to tell them apart, and colours.
void label_runs(std::vector<RunResults>* runs);

/// Runs that are repetitions of one thing: of one scene and settings, from folders whose names
/// differ in the number at their end alone (walk-001, walk-002).
struct RunGroup {
  std::string label;
  std::vector<size_t> runs;  ///< indices
};
std::vector<RunGroup> group_runs(const std::vector<RunResults>& runs);
/// Runs whose robots were at the same places at the same times, by their metrics, or, without such,
/// with the same state hash after as many steps: one motion, seen again by `gloam replay` or run
/// twice. Only sets of two and more.
std::vector<RunGroup> same_motions(const std::vector<RunResults>& runs);

}  // namespace gloam
