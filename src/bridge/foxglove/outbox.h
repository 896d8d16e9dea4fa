#pragma once
// Outbox: messages that wait for one client, bounded in bytes and in age. Any thread may add; the
// network's thread takes.

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace gloam::bridge::foxglove {

/// One WebSocket message: a head of its own and a body that clients may share.
struct Frame {
  std::string head;
  std::shared_ptr<const std::vector<uint8_t>> body = {};
  bool is_text = false;

  size_t size() const { return head.size() + (body != nullptr ? body->size() : 0); }
};

struct OutboxLimits {
  size_t data_bytes = size_t{16} << 20;      ///< of data; one message may be larger
  size_t kept_bytes = size_t{16} << 20;      ///< of others, before one more is added
  std::chrono::milliseconds data_age{1000};  ///< data that waited longer are not sent
};

class Outbox {
 public:
  /// `wake` is called where something waits after nothing did: on the adding thread.
  Outbox(std::function<void()> wake, const OutboxLimits& limits)
      : wake_(std::move(wake)), limits_(limits) {}

  /// A message that must arrive: answers, latched topics. Where too many wait, overflowed().
  void send(Frame frame);
  /// Data: the oldest make room for it.
  void offer(Frame frame);
  /// The next one; empty: nothing waits, and `wake` will tell.
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
  void add(Frame frame, bool is_kept);
  void make_room(size_t bytes);

  std::function<void()> wake_;
  const OutboxLimits limits_;
  mutable std::mutex mutex_;
  std::deque<Waiting> waiting_;
  size_t data_bytes_ = 0, kept_bytes_ = 0;
  int64_t dropped_ = 0;
  bool overflowed_ = false, closed_ = false, taking_ = false;
};

}  // namespace gloam::bridge::foxglove
