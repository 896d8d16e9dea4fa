#pragma once
// Snapshots of a running simulation for any number of clients.

#include <memory>

#include "gloam/snapshot_stream.h"
#include "runtime/streams/stream_context.h"
#include "runtime/streams/stream_thread.h"
#include "sim/loop/simulator.h"

namespace gloam {

class LiveSnapshots final : public SnapshotStream {
 public:
  /// `due` and `batch`: as SubscriptionOptions has them; `due` instead of the request's rate, empty
  /// = that.
  static Result<std::unique_ptr<LiveSnapshots>> open(const StreamContext& context,
                                                     const SnapshotRequest& request,
                                                     SnapshotCallback on_snapshot,
                                                     std::function<int64_t(int64_t)> due = {},
                                                     int batch = 1);
  int64_t dropped() const override { return thread_.dropped(); }
  int64_t complete_at(int64_t from) const override { return thread_.complete_at(from); }
  void flush() override { thread_.flush(); }
  Status status() const override { return thread_.status(); }

 private:
  explicit LiveSnapshots(SnapshotCallback on_snapshot) : on_snapshot_(std::move(on_snapshot)) {}

  SnapshotCallback on_snapshot_;
  std::shared_ptr<SensorAccount> account_;
  StreamThread thread_;  // last: it uses the other
};

}  // namespace gloam
