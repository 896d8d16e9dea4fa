#pragma once
// Metrics of a run in the making: the probes that they need, and their thread.

#include <memory>
#include <thread>

#include "metrics/metrics.h"
#include "record/recorder.h"
#include "runtime/live/live_simulation.h"
#include "runtime/recording/state_table.h"
#include "sim/snapshots/snapshot_queue.h"

namespace gloam {

struct RunMetricsRequest {
  bool has_renderer = false;  ///< pictures are made anyway
  bool records = false;       ///< metrics.csv is written
  double rate = 100;          ///< samples per second [Hz]
};
/// Metrics of a run, with a renderer for the light at robots that move about, where it is recorded
/// or an expression asks for it. Errors: of Metrics::make, and of the scene's media.
Result<std::unique_ptr<Metrics>> make_metrics(const World& world, LiveSimulation& simulation,
                                              const RunMetricsRequest& request);

/// The metrics' own consumer of Snapshots.
class MetricsThread {
 public:
  /// `recorder` and `state` may be null.
  MetricsThread(std::shared_ptr<SnapshotQueue> queue, Metrics& metrics, StateTable* state,
                Recorder* recorder);
  ~MetricsThread() { join(); }
  void join();

 private:
  std::shared_ptr<SnapshotQueue> queue_;
  std::thread thread_;
};

}  // namespace gloam
