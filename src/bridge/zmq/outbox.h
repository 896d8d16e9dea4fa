#pragma once
// Outbox: what other threads have for the sockets, which belong to one thread. Bounded: of a topic
// whose reader is slow the oldest messages are dropped and counted.

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "base/threads/bounded_queue.h"
#include "bridge/zmq/pack.h"
#include "gloam/result.h"

namespace gloam::bridge::zeromq {

/// Where a request came from: frames before its payload.
struct Envelope {
  std::string client;          ///< routing id
  bool has_delimiter = false;  ///< an empty frame, as REQ sockets send it
};

struct Reply {
  Envelope to;
  PackBuffer payload;
};

/// One message of a stream: topic, header, payload.
struct Publication {
  std::string topic;
  zmq::message_t header, payload;
  size_t bytes() const { return topic.size() + header.size() + payload.size(); }
};

/// Any thread.
class Outbox {
 public:
  /// Error: no event file descriptor.
  static Result<std::unique_ptr<Outbox>> create();
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void reply(Reply reply);
  void publish(Publication publication);

  /// Takes all that waits: topics in turn, each in its order.
  std::vector<Reply> take_replies();
  std::vector<Publication> take_publications();

  /// File descriptor that is readable when something waits.
  int wake_fd() const { return wake_fd_; }
  void wake();
  void clear_wake();

  int64_t dropped() const { return dropped_; }

 private:
  explicit Outbox(int wake_fd) : wake_fd_(wake_fd) {}

  const int wake_fd_;
  std::atomic<int64_t> dropped_{0};
  std::mutex mutex_;  // guards these two
  std::vector<Reply> replies_;
  std::map<std::string, BoundedQueue<Publication>> queues_;  // by topic
};

}  // namespace gloam::bridge::zeromq
