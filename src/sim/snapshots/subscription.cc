#include "sim/snapshots/subscription.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace gloam {
namespace {
constexpr int kLargestQueue = 65536;
constexpr double kLongestWindow = 1000;  // [s]
}  // namespace

Result<Subscription> Subscription::make(const SubscriptionOptions& options, Rational timestep,
                                        const std::shared_ptr<Signal>& signal) {
  if (options.capacity < 1 || options.capacity > kLargestQueue) {
    return Error{ErrorKind::kUsage, fmt::format("a queue of {} Snapshots is out of range (1 … {})",
                                                options.capacity, kLargestQueue)};
  }
  if (options.batch < 1 || options.batch > options.capacity) {
    return Error{ErrorKind::kUsage, fmt::format("a batch of {} Snapshots is out of range (1 … {})",
                                                options.batch, options.capacity)};
  }
  GLOAM_TRY(StepSchedule schedule, StepSchedule::make(options.rate, options.phase, timestep));
  if (options.window.num < 0 || options.window.den <= 0 || options.window.value() > kLongestWindow)
    return Error{ErrorKind::kUsage, fmt::format("a window of {:g} s is out of range (0 … {} s)",
                                                options.window.value(), kLongestWindow)};
  Subscription subscription;
  subscription.queue_ = std::make_shared<SnapshotQueue>(options, signal);
  subscription.keys_ = key_steps(options.window, timestep);
  subscription.queue_->set_schedule(schedule, subscription.keys_.length());
  // Events may come a step early or late, those of uneven schedules a quarter of a period: a window
  // must end before so many more have begun.
  const int64_t period = schedule.step_of(kMostPending) - schedule.step_of(0);
  const int64_t room = period - 2 - (options.due ? period / 4 / kMostPending : 0);
  if (subscription.keys_.length() > room) {
    return Error{ErrorKind::kUsage,
                 fmt::format("a window of {:g} s is too long for {:g} events per second",
                             options.window.value(), options.rate.value()),
                 {},
                 "use a shorter window or a lower rate"};
  }
  return subscription;
}

void Subscription::begin(int64_t from) {
  event_ = due_ = queue_->event_from(from);
  for (Pending& window : pending_) window = {};
  pending_count_ = 0;
}

// The instants of a window are of one World: those that are not complete will never be. Complete
// ones wait for room.
void Subscription::forget_windows() {
  int complete = 0;
  while (complete < pending_count_ &&
         pending_[static_cast<size_t>(complete)].window.count == keys_.count)
    ++complete;
  queue_->count_lost(pending_count_ - complete);
  for (int i = complete; i < pending_count_; ++i) pending_[static_cast<size_t>(i)] = {};
  pending_count_ = complete;
  if (complete == 0) due_ = event_;
}

// Snapshots of a full queue, of one with the reader, and of those being made.
int Subscription::slots() const {
  const SubscriptionOptions& options = queue_->options();
  const int made = options.window.num > 0 ? kMostPending : 1;
  return (options.capacity + 1 + made) * keys_.count;
}

bool Subscription::publish(int64_t step, Stepper& stepper, bool waits_for_sensors) {
  const SubscriptionOptions& options = queue_->options();
  const bool waits = options.required || (options.sensor && waits_for_sensors);
  if (event_ <= step) {
    GLOAM_CHECK(pending_count_ < kMostPending, "windows overlap more than allowed");
    pending_[static_cast<size_t>(pending_count_++)].first = step;
    event_ = queue_->event_from(event_ + 1);
  }
  const auto next_key = [&](const Pending& p) { return p.first + p.window.count * keys_.stride; };
  for (int i = 0; i < pending_count_; ++i) {
    Pending& p = pending_[static_cast<size_t>(i)];
    if (p.window.count < keys_.count && next_key(p) <= step) p.window.add(stepper.snapshot());
  }
  while (pending_count_ > 0 && pending_[0].window.count == keys_.count) {
    if (waits && !queue_->has_room()) return false;
    queue_->publish(std::exchange(pending_[0].window, {}));
    std::rotate(pending_.begin(), pending_.begin() + 1, pending_.begin() + pending_count_);
    --pending_count_;
  }
  due_ = event_;
  for (int i = 0; i < pending_count_; ++i)
    due_ = std::min(due_, next_key(pending_[static_cast<size_t>(i)]));
  return true;
}

}  // namespace gloam
