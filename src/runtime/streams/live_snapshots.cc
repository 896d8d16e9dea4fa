#include "runtime/streams/live_snapshots.h"

namespace gloam {

Result<std::unique_ptr<LiveSnapshots>> LiveSnapshots::open(const StreamContext& context,
                                                           const SnapshotRequest& request,
                                                           SnapshotCallback on_snapshot,
                                                           std::function<int64_t(int64_t)> due,
                                                           int batch) {
  std::unique_ptr<LiveSnapshots> live(new LiveSnapshots(std::move(on_snapshot)));
  const Rational timestep = context.simulator.timestep();
  const Rational every_step{timestep.den, timestep.num};
  const Rational rate = request.rate.num != 0 ? request.rate : every_step;
  live->account_ = context.costs.open(due ? "state topics" : "snapshots",
                                      due ? rate_of(due, timestep) : rate.value());
  GLOAM_TRY(auto queue, context.simulator.subscribe({.rate = rate,
                                                     .due = due,
                                                     .required = request.required,
                                                     .sensor = true,
                                                     .capacity = request.capacity,
                                                     .batch = batch}));
  live->thread_.start(std::move(queue), {.what = "a snapshot stream",
                                         .memory_hint = "hold fewer Snapshots",
                                         .take =
                                             [raw = live.get()](const SnapshotWindow& now) {
                                               raw->on_snapshot_(now.keys[0]);
                                               raw->account_->add_message(now.keys[0].time());
                                               return Status();
                                             },
                                         .on_end = request.on_end,
                                         .account = live->account_});
  return live;
}

}  // namespace gloam
