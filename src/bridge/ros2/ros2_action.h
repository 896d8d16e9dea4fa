#pragma once
// Ros2Action: one action of the node, free of DDS: three services and two topics.

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bridge/ros2/ros2_service.h"
#include "gloam/topics.h"

namespace gloam::bridge {

/// Sends a message, CDR with its head, to a topic by its full name. Any thread.
using Ros2Publish = std::function<void(const std::string& topic, std::span<const uint8_t> data)>;

struct Ros2Action {
  /// "/simulate_steps", full; its services and topics are NAME/_action/….
  std::string name;
  std::string type;                   ///< "simulation_interfaces/action/SimulateSteps"
  std::vector<Ros2Service> services;  ///< send_goal, cancel_goal, get_result
  std::vector<TopicInfo> topics;      ///< feedback, status: said through Ros2Publish
  /// Runner of goals; it ends with the last owner, before Ros2Publish does.
  std::shared_ptr<void> server;
};

}  // namespace gloam::bridge
