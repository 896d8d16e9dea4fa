#pragma once
// LogChannels: the channels of a log that is written, each CDR with its definition and the QoS that
// ROS 2's tools ask for.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "gloam/topics.h"
#include "mcap/log_queue.h"

namespace gloam {

/// All calls may come from any thread.
class LogChannels {
 public:
  explicit LogChannels(std::unique_ptr<LogQueue> queue) : queue_(std::move(queue)) {}

  LogQueue& queue() { return *queue_; }
  /// Declares a topic, once. Errors: Gloam has no such message, the queue's.
  Status add(const TopicInfo& topic);
  /// Writes a message of a topic; of one that was not declared it writes nothing. The queue's
  /// status() reports a failure.
  void write(const std::string& topic, uint64_t log_time, std::span<const uint8_t> data);

 private:
  struct Channel {
    uint16_t id;
    uint32_t sequence = 0;
  };

  std::unique_ptr<LogQueue> queue_;
  std::mutex mutex_;
  std::map<std::string, Channel> channels_;  // by topic
  std::map<std::string, uint16_t> schemas_;  // by message type
};

}  // namespace gloam
