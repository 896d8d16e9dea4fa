#include "runtime/streams/live_snapshots.h"

namespace gloam {

Result<std::unique_ptr<LiveSnapshots>> LiveSnapshots::open(Simulator& simulator,
                                                           const SnapshotRequest& request,
                                                           SnapshotCallback on_snapshot,
                                                           std::function<int64_t(int64_t)> due,
                                                           int batch) {
  std::unique_ptr<LiveSnapshots> live(new LiveSnapshots(std::move(on_snapshot)));
  const Rational timestep = simulator.timestep();
  const Rational every_step{timestep.den, timestep.num};
  GLOAM_TRY(auto queue,
            simulator.subscribe({.rate = request.rate.num != 0 ? request.rate : every_step,
                                 .due = std::move(due),
                                 .required = request.required,
                                 .capacity = request.capacity,
                                 .batch = batch}));
  live->thread_.start(std::move(queue), {.what = "a stream of snapshots",
                                         .memory_hint = "keep fewer Snapshots",
                                         .take =
                                             [raw = live.get()](const SnapshotWindow& now) {
                                               raw->on_snapshot_(now.keys[0]);
                                               return Status();
                                             },
                                         .on_end = request.on_end});
  return live;
}

}  // namespace gloam
