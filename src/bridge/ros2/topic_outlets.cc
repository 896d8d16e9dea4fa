#include "bridge/ros2/topic_outlets.h"

#include <algorithm>

#include "bridge/ros2/ros2_names.h"

namespace gloam::bridge {
namespace {

constexpr int kSmallMessageDepth = 100;  // of small messages, as tf2 keeps transforms

// A reliable writer matches both kinds of readers; a slow one loses the oldest all the same.
Result<DdsEndpoint> endpoint_of(const TopicInfo& topic) {
  GLOAM_TRY(const MessageInfo type, message_info(topic.type));
  TopicQos qos = topic.qos;
  qos.is_reliable = true;
  if (!topic.is_large) qos.depth = std::max(qos.depth, kSmallMessageDepth);
  return DdsEndpoint{.topic = dds_topic(topic.name),
                     .type = type.dds_name,
                     .type_hash = type.hash,
                     .qos = qos,
                     .is_large = topic.is_large};
}

}  // namespace

Status TopicOutlets::set_topics(const std::vector<TopicInfo>& topics) {
  const auto is_same = [](const TopicInfo& a, const TopicInfo& b) {
    return a.name == b.name && a.type == b.type && a.source == b.source;
  };
  std::map<std::string, std::shared_ptr<Outlet>> outlets;
  {
    const std::lock_guard lock(mutex_);
    outlets = outlets_;
  }
  std::erase_if(outlets, [&](const auto& outlet) {
    return std::ranges::none_of(
        topics, [&](const TopicInfo& topic) { return is_same(topic, outlet.second->topic); });
  });
  for (const TopicInfo& topic : topics) {
    if (outlets.contains(topic.name)) continue;
    GLOAM_TRY(const DdsEndpoint endpoint, endpoint_of(topic));
    auto outlet = std::make_shared<Outlet>();
    outlet->topic = topic;
    GLOAM_TRY(outlet->writer, node_.add_writer(endpoint, on_match_));
    outlets.emplace(topic.name, std::move(outlet));
  }
  const std::lock_guard lock(mutex_);
  outlets_.swap(outlets);
  return {};
}

void TopicOutlets::write(const TopicMessage& message) {
  std::shared_ptr<Outlet> outlet;
  {
    const std::lock_guard lock(mutex_);
    const auto found = outlets_.find(message.topic.name);
    if (found == outlets_.end()) return;
    outlet = found->second;
  }
  ++(outlet->writer->write(message.data) ? sent_ : lost_);
}

std::vector<std::string> TopicOutlets::wanted() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> wanted;
  for (const auto& [name, outlet] : outlets_)
    if (outlet->writer->readers() > 0) wanted.push_back(name);
  return wanted;
}

int TopicOutlets::subscriptions() const {
  const std::lock_guard lock(mutex_);
  int count = 0;
  for (const auto& [name, outlet] : outlets_) count += outlet->writer->readers();
  return count;
}

}  // namespace gloam::bridge
