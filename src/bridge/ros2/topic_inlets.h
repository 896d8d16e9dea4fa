#pragma once
// TopicInlets: the topics that a simulation hears, as DDS readers. Who sends a robot goals first is
// its only master until it has been silent for a second: others are refused and told of.

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "bridge/ros2/dds_node.h"
#include "gloam/simulation.h"

namespace gloam::bridge {

class TopicInlets {
 public:
  TopicInlets(Simulation& simulation, DdsNode& node) : simulation_(simulation), node_(node) {}

  Status set_topics(const std::vector<TopicInfo>& topics);
  /// Gives robots back whose masters are silent; a robot that was sent a velocity then stands.
  void release_silent();

  int64_t heard() const { return heard_; }
  int64_t refused() const { return refused_; }
  /// The newest refusal since the last call; empty = none.
  std::string take_refusal();

 private:
  using Clock = std::chrono::steady_clock;
  struct Master {
    std::string writer;  // its GUID
    std::unique_ptr<ControlLease> lease;
    Clock::time_point last;
    bool has_velocity = false;  // is moving by a velocity goal
  };
  struct Inlet {
    TopicInfo topic;
    std::unique_ptr<DdsReader> reader;
  };

  void take(const TopicInfo& topic, const DdsSample& sample);
  Status obey(const TopicInfo& topic, const DdsSample& sample);
  Status obey_as_master(const std::string& robot, const std::string& writer,
                        const std::vector<Command>& commands);

  Simulation& simulation_;
  DdsNode& node_;
  std::map<std::string, Inlet> inlets_;  // by name; of set_topics()
  std::mutex mutex_;
  std::map<std::string, Master> masters_;  // by robot
  std::string refusal_;
  std::atomic<int64_t> heard_{0}, refused_{0};
};

}  // namespace gloam::bridge
