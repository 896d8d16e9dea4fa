#pragma once
// BoundedQueue: items on their way from one thread to another, with an explicit policy for a full
// queue. It locks; the step loop has a queue without locks (sim/commands/lock_free_queue.h). More
// than 150 lines, because a template has its functions in its header.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace gloam {

/// Behaviour of push() while the queue is full.
enum class Overflow : uint8_t {
  kWait,        ///< waits for room: nothing is lost, but the producer is slowed down
  kDropOldest,  ///< drops the oldest items, and counts them
  kReject,      ///< refuses the new item
};

/// Most items that wait. One item alone may be larger than `bytes`.
struct QueueLimits {
  size_t items = SIZE_MAX;
  size_t bytes = SIZE_MAX;
};

struct ItemOptions {
  size_t bytes = 0;      ///< of the item, for the limit
  int64_t key = 0;       ///< not 0: replaces the newest waiting item if this has the same key
  bool is_kept = false;  ///< outside of the limits: added at once and never dropped
};

enum class PushResult : uint8_t { kAdded, kFull, kClosed };

/// All functions may be called from any thread. Items are destroyed without the lock, because their
/// destructors may use the queue.
template <class T>
class BoundedQueue {
 public:
  using Clock = std::chrono::steady_clock;

  BoundedQueue(const QueueLimits& limits, Overflow overflow)
      : limits_(limits), overflow_(overflow) {}
  BoundedQueue(const BoundedQueue&) = delete;
  BoundedQueue& operator=(const BoundedQueue&) = delete;

  /// `dropped`, if given, receives the items that were dropped for this one.
  PushResult push(T item, const ItemOptions& options = {}, std::vector<T>* dropped = nullptr) {
    std::vector<T> removed;
    {
      std::unique_lock lock(mutex_);
      if (!closed_ && replace_newest(item, options)) return PushResult::kAdded;
      const bool has_room = make_room(lock, options, &removed);
      if (closed_) return PushResult::kClosed;
      if (!has_room) return PushResult::kFull;
      waiting_.push_back({std::move(item), options});
      count(options, true);
    }
    added_.notify_one();
    if (dropped != nullptr) *dropped = std::move(removed);
    return PushResult::kAdded;
  }

  /// The oldest item, as soon as there is one. Empty: closed, and no item is left.
  std::optional<T> pop() {
    std::unique_lock lock(mutex_);
    added_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    return take_oldest();
  }
  /// The same; empty also where none has come by then.
  std::optional<T> pop_until(Clock::time_point time) {
    std::unique_lock lock(mutex_);
    added_.wait_until(lock, time, [this] { return closed_ || !waiting_.empty(); });
    return take_oldest();
  }
  std::optional<T> try_pop() {
    const std::lock_guard lock(mutex_);
    return take_oldest();
  }
  /// All items, the oldest first.
  std::vector<T> take_all() {
    const std::lock_guard lock(mutex_);
    std::vector<T> all;
    while (auto item = take_oldest()) all.push_back(std::move(*item));
    return all;
  }
  /// Waits until all items have been taken, or the queue is closed.
  void wait_until_empty() {
    std::unique_lock lock(mutex_);
    taken_.wait(lock, [this] { return closed_ || waiting_.empty(); });
  }

  /// Nothing is added any more; waiting producers and consumers return. Items stay until they are
  /// taken.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    added_.notify_all();
    taken_.notify_all();
  }
  /// Closed, and all items have been taken.
  bool has_ended() const {
    const std::lock_guard lock(mutex_);
    return closed_ && waiting_.empty();
  }
  bool is_empty() const {
    const std::lock_guard lock(mutex_);
    return waiting_.empty();
  }
  /// Items lost by Overflow::kDropOldest.
  uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  struct Waiting {
    T item;
    ItemOptions options;
  };

  bool is_full(size_t more) const {
    if (items_ == 0) return false;
    return items_ >= limits_.items || bytes_ > limits_.bytes || more > limits_.bytes - bytes_;
  }
  bool replace_newest(T& item, const ItemOptions& options) {
    if (options.key == 0 || waiting_.empty() || waiting_.back().options.key != options.key)
      return false;
    Waiting& newest = waiting_.back();
    count(newest.options, false);
    count(options, true);
    newest.options = options;
    std::swap(newest.item, item);
    return true;
  }
  bool make_room(std::unique_lock<std::mutex>& lock, const ItemOptions& options,
                 std::vector<T>* removed) {
    if (options.is_kept) return true;
    if (overflow_ == Overflow::kWait)
      taken_.wait(lock, [&] { return closed_ || !is_full(options.bytes); });
    while (overflow_ == Overflow::kDropOldest && !closed_ && is_full(options.bytes)) {
      const auto oldest = std::find_if(waiting_.begin(), waiting_.end(),
                                       [](const Waiting& w) { return !w.options.is_kept; });
      count(oldest->options, false);
      removed->push_back(std::move(oldest->item));
      waiting_.erase(oldest);
      ++dropped_;
    }
    return !is_full(options.bytes);
  }
  std::optional<T> take_oldest() {
    if (waiting_.empty()) return {};
    std::optional<T> item = std::move(waiting_.front().item);
    count(waiting_.front().options, false);
    waiting_.pop_front();
    taken_.notify_all();
    return item;
  }
  void count(const ItemOptions& options, bool is_added) {
    if (options.is_kept) return;
    items_ += is_added ? 1 : -1;
    bytes_ += is_added ? options.bytes : -options.bytes;
  }

  const QueueLimits limits_;
  const Overflow overflow_;
  mutable std::mutex mutex_;
  std::condition_variable added_, taken_;
  std::deque<Waiting> waiting_;
  size_t items_ = 0, bytes_ = 0;  // of waiting_, without kept items
  uint64_t dropped_ = 0;
  bool closed_ = false;
};

}  // namespace gloam
