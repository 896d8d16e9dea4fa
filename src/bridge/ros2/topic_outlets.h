#pragma once
// TopicOutlets: the output topics of a simulation as DDS writers.

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "bridge/ros2/dds_node.h"
#include "gloam/topics.h"

namespace gloam::bridge {

/// Any thread, but for set_topics().
class TopicOutlets {
 public:
  /// `on_match`: subscriptions came or went; on any thread, must not block.
  TopicOutlets(DdsNode& node, std::function<void()> on_match)
      : node_(node), on_match_(std::move(on_match)) {}

  /// Creates writers for new topics and removes the writers of topics that are gone.
  Status set_topics(const std::vector<TopicInfo>& topics);
  void write(const TopicMessage& message);
  /// Topics that have subscriptions.
  std::vector<std::string> wanted() const;

  int subscriptions() const;
  int64_t sent() const { return sent_; }
  int64_t lost() const { return lost_; }

 private:
  struct Outlet {
    TopicInfo topic;
    std::unique_ptr<DdsWriter> writer;
  };

  DdsNode& node_;
  const std::function<void()> on_match_;
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Outlet>> outlets_;  // by name
  std::atomic<int64_t> sent_{0}, lost_{0};
};

}  // namespace gloam::bridge
