#include "runtime/recording/run_report.h"

#include "base/hash.h"

namespace gloam {

RunOutcome run_outcome(const RunReport& report, const RunTimes& times, const Metrics& metrics,
                       const std::vector<NamedNumber>& sensing) {
  RunOutcome outcome;
  outcome.exit_reason = report.status.ok() ? "completed" : report.status.error().to_string();
  outcome.steps = report.steps;
  outcome.simulated = report.sim_time;
  outcome.final_state_hash = hash_to_hex(report.hash);
  outcome.timings = {{"prepare_s", times.prepared},
                     {"run_s", times.simulated - times.prepared},
                     {"total_s", times.drained}};
  outcome.results = metrics.summary();
  outcome.results.insert(outcome.results.end(), sensing.begin(), sensing.end());
  outcome.missing_metrics = metrics.missing();
  for (const Metrics::Episode& episode : metrics.episodes())
    outcome.episodes.push_back(
        {episode.steps, episode.duration, hash_to_hex(episode.hash), episode.results});
  return outcome;
}

std::vector<std::string> main_files(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  for (const char* name :
       {"contact_sheet.png", "metrics.csv", "state.csv", "summary.json", "labels.json"})
    if (std::filesystem::exists(folder / name)) files.push_back((folder / name).string());
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(folder, code))
    if (entry.path().extension() == ".mp4") files.push_back(entry.path().string());
  return files;
}

}  // namespace gloam
