#include "sim/snapshots/snapshot_queue.h"

namespace gloam {

// Twice the room that is used: a reader that is interrupted in the middle of a pop holds a cell,
// and the writer must be able to go on around it.
SnapshotQueue::SnapshotQueue(const SubscriptionOptions& options, std::shared_ptr<Signal> sim_signal)
    : options_(options), queue_(2 * options.capacity), sim_signal_(std::move(sim_signal)) {}

SnapshotWindow SnapshotQueue::try_next_window() {
  SnapshotWindow window;
  if (queue_.try_pop(window) && (options_.required || options_.sensor) &&
      is_awaited_.exchange(false, std::memory_order_acq_rel))
    sim_signal_->raise();
  return window;
}

// Whichever of the two exchanges comes second sees what happened before the first: the reader finds
// that it is awaited, or the sim thread finds the room.
bool SnapshotQueue::has_room() {
  if (!full()) return true;
  is_awaited_.exchange(true, std::memory_order_acq_rel);
  return !full();
}

int64_t SnapshotQueue::event_from(int64_t step) const {
  if (options_.due) return options_.due(step);
  return schedule_.step_of(schedule_.first_at_or_after(step));
}

void SnapshotQueue::flush() {
  if (queue_.size() > 0) readers_.raise();
}

SnapshotWindow SnapshotQueue::next_window() {
  for (;;) {
    const uint32_t ticket = readers_.ticket();
    const bool was_closed = closed();
    if (SnapshotWindow window = try_next_window()) return window;
    if (was_closed) return {};
    readers_.wait(ticket);
  }
}

SnapshotWindow SnapshotQueue::next_window_or_wake() {
  for (;;) {
    const uint32_t ticket = readers_.ticket();
    const bool was_closed = closed();
    if (SnapshotWindow window = try_next_window()) return window;
    if (was_closed || woken_.exchange(false, std::memory_order_acq_rel)) return {};
    readers_.wait(ticket);
  }
}

void SnapshotQueue::wake() {
  woken_.store(true, std::memory_order_release);
  readers_.raise();
}

void SnapshotQueue::close() {
  closed_.store(true, std::memory_order_release);
  readers_.raise();
  sim_signal_->raise();
}

void SnapshotQueue::publish(SnapshotWindow window) {
  SnapshotWindow oldest;
  while (full() && queue_.try_pop(oldest)) {
    oldest = {};
    dropped_.fetch_add(1, std::memory_order_relaxed);
    handed_out_.fetch_sub(1, std::memory_order_release);
  }
  // Counted before a reader can have it, so that none ever has more than were handed out.
  handed_out_.fetch_add(1, std::memory_order_release);
  if (!queue_.try_push(window)) {
    handed_out_.fetch_sub(1, std::memory_order_release);
    dropped_.fetch_add(1, std::memory_order_relaxed);
  }
  if (is_batch()) readers_.raise();
}

// Whether readers are to be woken for what waits.
bool SnapshotQueue::is_batch() {
  if (options_.batch == 1) return true;
  const auto now = std::chrono::steady_clock::now();
  if (queue_.size() < options_.batch && now - woken_at_ < kLongestBatch) return false;
  woken_at_ = now;
  return true;
}

}  // namespace gloam
