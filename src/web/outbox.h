#pragma once
// Outbox: messages that wait for one client, bounded in bytes and in age. Any thread may add; the
// network's thread takes.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/threads/bounded_queue.h"

namespace gloam::web {

/// One WebSocket message: a head of its own and a body that clients may share.
struct Frame {
  std::string head;
  std::shared_ptr<const std::vector<uint8_t>> body = {};
  bool is_text = false;

  size_t size() const { return head.size() + (body != nullptr ? body->size() : 0); }
};

struct OutboxOptions {
  size_t data_bytes = size_t{16} << 20;      ///< of data; one message may be larger
  size_t kept_bytes = size_t{16} << 20;      ///< of others, before one more is added
  std::chrono::milliseconds data_age{1000};  ///< data that waited longer are not sent
  /// One element per slot of replace(): frames that are sent ahead of acknowledge(); 0 = any
  /// number.
  std::vector<int> slots = {};
};

class Outbox {
 public:
  /// `wake` is called where something waits after nothing did: on the adding thread.
  Outbox(std::function<void()> wake, const OutboxOptions& options)
      : wake_(std::move(wake)),
        options_(options),
        waiting_({.bytes = options.data_bytes}, Overflow::kDropOldest),
        slots_(options.slots.size()) {}

  /// A message that must arrive: answers, latched topics. Where too many wait, overflowed().
  void send(Frame frame);
  /// Data: the oldest make room for it.
  void offer(Frame frame);
  /// A frame that replaces the waiting frame of its slot. Slots are sent in their order, after all
  /// other messages.
  void replace(size_t slot, Frame frame);
  /// A frame that is of use only after the one before it: if that one still waits, both are
  /// dropped. Returns whether it was taken.
  bool append(size_t slot, Frame frame);
  /// The client has processed a frame of a slot whose number of frames is limited.
  void acknowledge(size_t slot);
  /// The next one; empty: nothing can be sent, and `wake` is called when this changes.
  std::optional<Frame> next();
  /// The client reads too slowly to be kept.
  bool overflowed() const;
  int64_t dropped() const;
  /// Nothing is added or taken any more; `wake` is not called again.
  void close();

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    Frame frame;
    bool is_kept = false;
    Clock::time_point since;
  };
  struct Slot {
    std::optional<Frame> newest;
    int unacknowledged = 0;
  };
  void add(Frame frame, bool is_kept);
  std::optional<Frame> next_of_slots();
  void wake_taker();

  std::function<void()> wake_;
  const OutboxOptions options_;
  mutable std::mutex mutex_;
  BoundedQueue<Waiting> waiting_;
  std::vector<Slot> slots_;
  size_t kept_bytes_ = 0;
  int64_t outdated_ = 0;  // data that were not sent because of their age
  bool overflowed_ = false, closed_ = false, taking_ = false;
};

}  // namespace gloam::web
