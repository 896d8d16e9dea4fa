#pragma once
// Answers requests for the model and its fields on a thread of its own: a forward pass of a large
// model takes milliseconds.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "gloam/simulation.h"
#include "studio/messages.h"

namespace gloam::studio {

class Inspector {
 public:
  /// Called on the inspector's thread.
  struct Outputs {
    std::function<Snapshot()> shown;  ///< instant that clients look at
    std::function<void(int64_t client, std::string text)> text;
    std::function<void(int64_t client, std::vector<uint8_t> bytes)> reply;
    /// Replaces an earlier one that has not been sent.
    std::function<void(int64_t client, std::vector<uint8_t> bytes)> watched;
  };
  explicit Inspector(Simulation& simulation, Outputs outputs);
  ~Inspector();

  void start();
  /// Queues a Describe, Get, Watch or CopyState message. False: too many wait.
  bool post(int64_t client, const ControlMessage& message);
  void forget(int64_t client);
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  struct Request {
    int64_t client;
    ControlMessage message;
  };
  struct Watcher {
    WatchMessage wish;
    Clock::time_point due;
    uint64_t seen = 0;        ///< number of the instant that it was sent last
    bool has_warned = false;  ///< of fields that do not exist
  };
  void run();
  void answer(const Request& request);
  void do_message(int64_t client, const DescribeMessage&);
  void do_message(int64_t client, const GetMessage& message);
  void do_message(int64_t client, const WatchMessage& message);
  void do_message(int64_t client, const CopyStateMessage&);
  void serve_watchers();
  void report(int64_t client, const std::vector<std::string>& problems);
  bool look();

  Simulation& simulation_;
  const Outputs outputs_;
  std::mutex mutex_;  // guards these
  std::condition_variable wake_;
  std::deque<Request> requests_;
  std::vector<int64_t> gone_;
  bool stopping_ = false;

  // The inspector's thread only.
  std::map<int64_t, Watcher> watchers_;
  Snapshot snapshot_;  // that instant_ has solved
  Instant instant_;
  uint64_t looks_ = 0;  // instants solved
  std::thread thread_;
};

}  // namespace gloam::studio
