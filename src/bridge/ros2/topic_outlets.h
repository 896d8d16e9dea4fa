#pragma once
// TopicOutlets: the topics that a simulation says, as DDS writers. A topic is opened while somebody
// subscribes to it; topics of one source (a camera, a robot) share a stream, so that one picture
// serves all of them.

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bridge/ros2/dds_node.h"
#include "gloam/simulation.h"

namespace gloam::bridge {

class TopicOutlets {
 public:
  /// `on_match`: subscriptions came or went; on any thread, must not block.
  TopicOutlets(Simulation& simulation, DdsNode& node, std::function<void()> on_match);
  ~TopicOutlets();

  /// Makes writers for the topics that are new and takes away those that are gone.
  Status set_topics(const std::vector<TopicInfo>& topics);
  /// Opens what is subscribed to, and closes what has not been for a while. One thread. Error: a
  /// stream that cannot be opened; the others are.
  Status follow_subscriptions();

  int subscriptions() const;
  int64_t sent() const { return sent_; }
  int64_t dropped() const;

 private:
  struct Outlet {
    TopicInfo topic;
    std::unique_ptr<DdsWriter> writer;
  };
  /// Topics of one source and the stream of those that are open.
  struct Group {
    std::map<std::string, std::shared_ptr<Outlet>> outlets;  // by name
    std::vector<std::string> open;
    std::unique_ptr<TopicStream> stream;
    std::chrono::steady_clock::time_point wanted;  // when all that is open was last subscribed to
    std::string failed;                            // what could not be opened, not tried again
  };

  Status add(const TopicInfo& topic);
  Status follow(Group* group);

  Simulation& simulation_;
  DdsNode& node_;
  const std::function<void()> on_match_;
  mutable std::mutex mutex_;             // of groups_ as others ask for numbers
  std::map<std::string, Group> groups_;  // by source
  std::atomic<int64_t> sent_{0}, lost_{0};
};

}  // namespace gloam::bridge
