#pragma once
// TopicGroup: topics of one source (a camera, a robot), the stream that serves them, and the
// readers of each.

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "gloam/simulation.h"

namespace gloam {

/// A subscription's sink, until the subscription ends.
class SharedSink {
 public:
  explicit SharedSink(TopicSink& sink) : sink_(&sink) {}

  /// Calls `call` with the sink, unless the subscription has ended.
  template <class Call>
  void with_sink(const Call& call) {
    const std::shared_lock lock(mutex_);
    if (sink_ != nullptr) call(*sink_);
  }
  /// Waits for calls that are under way; there are none after it.
  void end() {
    const std::unique_lock lock(mutex_);
    sink_ = nullptr;
  }

 private:
  std::shared_mutex mutex_;
  TopicSink* sink_;
};

using SharedSinks = std::vector<std::shared_ptr<SharedSink>>;

/// The hub's thread alone calls it, except for visit_last() and dropped().
class TopicGroup {
 public:
  using Clock = std::chrono::steady_clock;

  /// `on_end`: its stream has ended by itself; comes on any thread.
  TopicGroup(Simulation& simulation, std::function<void()> on_end)
      : simulation_(simulation), on_end_(std::move(on_end)) {}

  /// Readers of a topic from now on; new ones get the last message of a latched topic.
  void set_readers(const std::string& topic, const SharedSinks& readers);
  /// Removes a topic that no longer exists.
  void remove(const std::string& topic);
  std::vector<std::string> topics() const;
  /// Opens the topics that have readers, and closes those that have had none for a while.
  void settle(Clock::time_point now);
  /// Why a topic is not open; null if it is.
  const Error* error_of(const std::string& topic) const;
  bool is_empty() const { return outlets_.empty(); }
  /// Closes the stream, which waits for its last callback.
  void close();

  // Any thread.
  bool visit_last(const std::string& topic, const TopicCallback& visit);
  int64_t dropped() const;

 private:
  /// A message with its data.
  struct Kept {
    TopicInfo topic;
    int64_t run = -1, step = 0;
    double time = 0, delivery = 0;
    std::vector<uint8_t> data;
    TopicMessage message() const { return {topic, run, step, time, delivery, data}; }
  };
  struct Outlet {
    SharedSinks readers;
    Clock::time_point wanted;          // when it had readers last
    std::shared_ptr<const Kept> last;  // of a latched topic
  };

  void deliver(const TopicMessage& message);
  void deliver_latched(const TopicMessage& message);
  SharedSinks readers_of(const std::string& topic) const;
  void take_end(Clock::time_point now);
  std::vector<std::string> wanted_topics(Clock::time_point now);
  Status open(const std::vector<std::string>& topics);

  Simulation& simulation_;
  const std::function<void()> on_end_;
  mutable std::mutex mutex_;  // guards these
  std::map<std::string, Outlet> outlets_;
  std::optional<Error> ended_;           // why the stream ended by itself
  std::shared_ptr<TopicStream> stream_;  // null = none is open
  int64_t lost_before_ = 0;              // by streams that are closed

  std::mutex latched_mutex_;  // one latched message at a time

  // The hub's thread.
  std::vector<std::string> open_;
  std::optional<Error> error_;
  Clock::time_point next_try_{};
};

}  // namespace gloam
