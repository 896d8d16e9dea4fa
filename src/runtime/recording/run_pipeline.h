#pragma once
// RunPipeline: a recorded run from its simulation, over the streams, to the last file.

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/live/live_simulation.h"
#include "runtime/log/log_recorder.h"
#include "runtime/recording/run_metrics.h"
#include "runtime/recording/run_plan.h"
#include "runtime/recording/run_progress.h"
#include "runtime/recording/run_report.h"
#include "runtime/recording/sensing_metrics.h"
#include "runtime/recording/state_table.h"
#include "sim/loop/motion.h"

namespace gloam {

class RunPipeline {
 public:
  /// Opens all that the plan names. `motion` takes the place of physics if it is not null. Errors:
  /// a part of the plan cannot be opened; `progress` has stopped the run, before anything is
  /// written.
  static Result<std::unique_ptr<RunPipeline>> open(RunPlan plan, std::unique_ptr<Motion> motion,
                                                   ProgressCallback progress);
  /// Runs to the end of the plan, or until a part fails or `progress` stops it, then closes the
  /// streams and finishes the files. Call once.
  RunReport run() {
    simulate();
    drain();
    return report();
  }

 private:
  RunPipeline(RunPlan plan, ProgressCallback progress)
      : plan_(std::move(plan)), progress_(std::move(progress)) {}
  Status open_simulation(std::unique_ptr<Motion> motion);
  Status open_metrics();
  Status open_folder();
  Status open_cameras(const std::vector<CameraRequest>& requests);
  Status open_lidars(const std::vector<RecordedLidar>& lidars);
  Status open_log();
  Status start_metrics();
  void simulate();
  void drain();
  Status drain_pictures();
  RunReport report();

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Status show(Progress now);
  Status parts_status() const;
  // Keeps the first reason for which the run ended early.
  void keep(const Status& status) {
    if (report_.status.ok()) report_.status = status;
  }

  // A part uses those before it: they end in the reverse order.
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const RunPlan plan_;
  const ProgressCallback progress_;
  RunReport report_;
  RunTimes times_;
  std::unique_ptr<LiveSimulation> simulation_;
  int64_t first_step_ = 0, last_step_ = 0;
  std::unique_ptr<Metrics> metrics_;
  std::optional<StateTable> state_;
  std::unique_ptr<Recorder> recorder_;  // null without a results folder
  SensingMetrics sensing_;
  std::vector<std::unique_ptr<LiveCamera>> cameras_;
  std::unique_ptr<LiveSensors> sensors_;  // null if no sensors are recorded
  std::vector<std::unique_ptr<LiveLidar>> lidars_;
  std::unique_ptr<LogRecorder> log_;  // null without a log
  RunProgress::Cameras drawing_;      // cameras of the recorder and the log
  std::optional<RunProgress> done_;
  std::optional<MetricsThread> metrics_thread_;
};

/// run_and_record() of bodies that `motion` moves; null = by physics.
Result<RunReport> record_motion(const World& world, const RunRequest& request,
                                std::unique_ptr<Motion> motion, const ProgressCallback& progress);

}  // namespace gloam
