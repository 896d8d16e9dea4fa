#include "bridge/ros2/node_services.h"

#include "bridge/ros2/ros2_names.h"
#include "bridge/ros2/services/actions.h"
#include "bridge/ros2/services/parameter_services.h"
#include "bridge/ros2/services/simulation_services.h"

namespace gloam::bridge {

Status NodeServices::open(int interfaces, const std::string& ns, const std::string& node) {
  interfaces_ = interfaces;
  for (Ros2Service& service : simulation_services(operations_, interfaces, ns))
    GLOAM_TRY_STATUS(server_.add(std::move(service)));
  GLOAM_TRY_STATUS(add_writer({.name = kParameterEvents,
                               .type = "rcl_interfaces/msg/ParameterEvent",
                               .qos = {.is_reliable = true, .depth = 1000}}));
  for (Ros2Service& service : parameter_services(operations_, ns + "/" + node, publisher()))
    GLOAM_TRY_STATUS(server_.add(std::move(service)));
  GLOAM_TRY_STATUS(add_action(simulate_steps_action(operations_, ns, publisher())));
  return follow_robots();
}

Status NodeServices::follow_robots() {
  for (const std::string& robot : trajectory_robots(operations_.simulation())) {
    if (!robots_.insert(robot).second) continue;
    GLOAM_TRY_STATUS(
        add_action(trajectory_action(operations_.simulation(), robot, interfaces_, publisher())));
  }
  return {};
}

Status NodeServices::add_writer(const TopicInfo& topic) {
  GLOAM_TRY(const MessageInfo type, message_info(topic.type));
  GLOAM_TRY(auto writer, node_.add_writer({.topic = dds_topic(topic.name),
                                           .type = type.dds_name,
                                           .type_hash = type.hash,
                                           .qos = topic.qos}));
  const std::lock_guard lock(writers_->mutex);
  writers_->by_topic.emplace(topic.name, std::move(writer));
  return {};
}

Status NodeServices::add_action(Ros2Action action) {
  for (const TopicInfo& topic : action.topics) GLOAM_TRY_STATUS(add_writer(topic));
  for (Ros2Service& service : action.services) GLOAM_TRY_STATUS(server_.add(std::move(service)));
  return {};
}

Ros2Publish NodeServices::publisher() const {
  return [writers = writers_](const std::string& topic, std::span<const uint8_t> data) {
    const std::lock_guard lock(writers->mutex);
    const auto found = writers->by_topic.find(topic);
    if (found != writers->by_topic.end()) found->second->write(data);
  };
}

}  // namespace gloam::bridge
