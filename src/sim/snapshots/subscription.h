#pragma once
// A subscription's end at the simulation: which Snapshots it wants, and the windows of them that
// are not yet complete.

#include <array>
#include <memory>

#include "sim/loop/step_schedule.h"
#include "sim/loop/stepper.h"
#include "sim/snapshots/snapshot_queue.h"

namespace gloam {

class Subscription {
 public:
  /// Errors: a capacity, rate or window that cannot be.
  static Result<Subscription> make(const SubscriptionOptions& options, Rational timestep,
                                   const std::shared_ptr<Signal>& signal);

  const std::shared_ptr<SnapshotQueue>& queue() const { return queue_; }
  /// Step at which something has to be done.
  int64_t due() const { return due_; }
  /// Snapshots that it may keep from being used again.
  int slots() const;

  /// From step `from` on, without what was before.
  void begin(int64_t from);
  /// After a recompile.
  void forget_windows();
  /// Takes the Snapshot of this step where it belongs, and hands out what is complete. False when
  /// there is no room for it and the simulation waits: for required queues, and for those of
  /// sensors where `waits_for_sensors`.
  bool publish(int64_t step, Stepper& stepper, bool waits_for_sensors);

 private:
  /// A window that is not yet handed out.
  struct Pending {
    int64_t first = 0;  // step
    SnapshotWindow window;
  };
  static constexpr int kMostPending = 5;

  Subscription() = default;
  std::shared_ptr<SnapshotQueue> queue_;
  KeySteps keys_;
  int64_t event_ = 0;  // step of the next event
  int64_t due_ = 0;
  std::array<Pending, kMostPending> pending_{};  // in the order of their events
  int pending_count_ = 0;
};

}  // namespace gloam
