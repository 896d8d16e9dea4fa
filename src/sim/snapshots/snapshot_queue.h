#pragma once
// A subscription's end at the consumer: Snapshots, or windows of them, in order, on a schedule.

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>

#include "sim/commands/lock_free_queue.h"
#include "sim/loop/step_schedule.h"
#include "sim/snapshots/snapshot_window.h"

namespace gloam {

/// Wakes a thread that waits for one of several things.
class Signal {
 public:
  uint32_t ticket() const { return value_.load(std::memory_order_acquire); }
  void raise() {
    value_.fetch_add(1, std::memory_order_acq_rel);
    value_.notify_all();
  }
  /// Returns once raise() has been called since `ticket` was taken.
  void wait(uint32_t ticket) const { value_.wait(ticket, std::memory_order_acquire); }

 private:
  std::atomic<uint32_t> value_{0};
};

struct SubscriptionOptions {
  Rational rate = {20, 1};  ///< Snapshots per second of simulation time, at most the step rate [Hz]
  Rational phase = {0, 1};  ///< time of the first one [s], >= 0
  /// Instead of rate and phase, of schedules that are not even: the first step at or after the one
  /// given at which there is a Snapshot. Pure; the sim thread calls it.
  std::function<int64_t(int64_t step)> due = {};
  bool required = false;  ///< the simulation waits while the queue is full and nothing is lost
                          ///< (but what it waits with when a reset comes); else the oldest are
                          ///< dropped and counted
  bool sensor = false;    ///< the simulation waits as for a required one while its pace is
                          ///< Pace::kSensors
  int capacity = 8;       ///< Snapshots (or windows) that wait to be consumed, 1 … 65536
  /// Snapshots (or windows) that wait before a sleeping reader is woken, 1 … capacity; it gets
  /// fewer when the simulation stands still, and when the last of them comes kLongestBatch of wall
  /// time after it was woken last. Waking a thread costs the sim thread about 10 µs. More than 1 is
  /// for readers that are in no hurry and whose thread waits for nothing else of the simulation.
  int batch = 1;
  /// Length of a window from each event on [s], >= 0: instead of one Snapshot there are several, as
  /// key_steps() says, handed out together once the last of them is there. An event is dropped as a
  /// whole. Windows may reach beyond the next event, up to four of them.
  Rational window = {0, 1};
};

constexpr std::chrono::milliseconds kLongestBatch{200};

/// Blocking reads from any number of threads; the sim thread is the only writer and takes no lock.
class SnapshotQueue final : public SnapshotSource {
 public:
  SnapshotQueue(const SubscriptionOptions& options, std::shared_ptr<Signal> sim_signal);

  /// The next window; waits for it. Empty once the simulation has stopped or this queue was closed,
  /// and everything before that has been read.
  SnapshotWindow next_window();
  /// The same, but empty also when wake() has been called since the last such call.
  SnapshotWindow next_window_or_wake();
  void wake();
  /// The next window if there is one now, else an empty one.
  SnapshotWindow try_next_window();
  /// Next window's first Snapshot, for subscriptions without windows.
  Snapshot next() override { return std::move(next_window().keys[0]); }
  Snapshot try_next() { return std::move(try_next_window().keys[0]); }
  /// Ends the subscription: the simulation forgets it, waiting readers return.
  void close();

  bool closed() const { return closed_.load(std::memory_order_acquire); }
  /// Snapshots lost since the subscription began because the reader was too slow.
  int64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }
  const SubscriptionOptions& options() const { return options_; }
  /// The first event at or after `step`, and the step at which the window of one that is then is
  /// complete.
  int64_t event_from(int64_t step) const;
  int64_t complete_at(int64_t from) const { return event_from(from) + window_steps_; }
  /// Windows that readers have got or will get, since the subscription began.
  int64_t handed_out() const { return handed_out_.load(std::memory_order_acquire); }

  /// Counts a window that a reader has made itself among those handed out.
  void count_own() { handed_out_.fetch_add(1, std::memory_order_release); }

  // ---- the sim thread's side ----
  /// Once, before it is published to.
  void set_schedule(const StepSchedule& schedule, int64_t window_steps) {
    schedule_ = schedule;
    window_steps_ = window_steps;
  }
  /// Counts Snapshots that could not be completed.
  void count_lost(int64_t count) { dropped_.fetch_add(count, std::memory_order_relaxed); }
  /// Whether another window fits. Of a queue that the simulation waits for: if not, the sim's
  /// Signal is raised once one does.
  bool has_room();
  /// Wakes readers for what waits, be it less than a batch.
  void flush();
  /// Queues that the simulation waits for must not be full.
  void publish(SnapshotWindow window);

 private:
  bool is_batch();
  bool full() const { return queue_.size() >= options_.capacity; }

  SubscriptionOptions options_;
  LockFreeQueue<SnapshotWindow> queue_;
  Signal readers_;
  std::shared_ptr<Signal> sim_signal_;
  std::atomic<bool> closed_{false}, woken_{false};
  std::atomic<bool> is_awaited_{false};  // the sim thread found it full
  std::atomic<int64_t> dropped_{0}, handed_out_{0};
  StepSchedule schedule_;
  int64_t window_steps_ = 0;
  std::chrono::steady_clock::time_point woken_at_{};  // the sim thread's
};

}  // namespace gloam
