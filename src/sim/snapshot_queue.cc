#include "sim/snapshot_queue.h"

namespace gloam {

// Twice the room that is used: a reader that is interrupted in the middle of a pop holds a cell,
// and the writer must be able to go on around it.
SnapshotQueue::SnapshotQueue(const SubscriptionOptions& options, std::shared_ptr<Signal> sim_signal)
    : options_(options), queue_(2 * options.capacity), sim_signal_(std::move(sim_signal)) {}

Snapshot SnapshotQueue::try_next() {
  Snapshot snapshot;
  if (queue_.try_pop(snapshot) && options_.required) sim_signal_->raise();
  return snapshot;
}

Snapshot SnapshotQueue::next() {
  for (;;) {
    const uint32_t ticket = readers_.ticket();
    const bool was_closed = closed();
    if (Snapshot snapshot = try_next()) return snapshot;
    if (was_closed) return {};
    readers_.wait(ticket);
  }
}

void SnapshotQueue::close() {
  closed_.store(true, std::memory_order_release);
  readers_.raise();
  sim_signal_->raise();
}

void SnapshotQueue::publish(Snapshot snapshot) {
  Snapshot oldest;
  while (full() && queue_.try_pop(oldest)) {
    oldest = {};
    dropped_.fetch_add(1, std::memory_order_relaxed);
  }
  if (!queue_.try_push(snapshot)) dropped_.fetch_add(1, std::memory_order_relaxed);
  readers_.raise();
}

}  // namespace gloam
