#pragma once
// NodeServices: what the node offers besides topics: simulation_interfaces, actions, parameters.

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "bridge/operations/operator.h"
#include "bridge/ros2/dds_node.h"
#include "bridge/ros2/ros2_action.h"
#include "bridge/ros2/service_server.h"
#include "gloam/scene/bridge.h"

namespace gloam::bridge {

class NodeServices {
 public:
  /// All must live longer. `ns`: "" or "/sim"; `node`: its name.
  NodeServices(Operator& operations, DdsNode& node, ServiceServer& server)
      : operations_(operations), node_(node), server_(server) {}

  Status open(int interfaces, const std::string& ns, const std::string& node);
  /// Actions of robots that are new in the World; of those that are gone goals are refused.
  Status follow_robots();

 private:
  /// Writers of what actions and parameters say. Shared: goals may end after NodeServices.
  struct Writers {
    std::mutex mutex;
    std::map<std::string, std::unique_ptr<DdsWriter>> by_topic;
  };

  Status add_writer(const TopicInfo& topic);
  Status add_action(Ros2Action action);
  Ros2Publish publisher() const;

  Operator& operations_;
  DdsNode& node_;
  ServiceServer& server_;
  int interfaces_ = 2;
  std::shared_ptr<Writers> writers_ = std::make_shared<Writers>();
  std::set<std::string> robots_;  // that have an action
};

}  // namespace gloam::bridge
