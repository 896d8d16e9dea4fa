#include "runtime/log/log_channels.h"

#include <fmt/format.h>

namespace gloam {
namespace {

// As rosbag2 writes it: YAML, with the numbers of rmw's enums.
std::string qos_text(const TopicQos& qos) {
  return fmt::format(
      "- history: 1\n  depth: {}\n  reliability: {}\n  durability: {}\n  deadline:\n    sec: "
      "9223372036\n    nsec: 854775807\n  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n  "
      "liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n  "
      "avoid_ros_namespace_conventions: false",
      qos.depth, qos.is_reliable ? 1 : 2, qos.is_latched ? 1 : 2);
}

}  // namespace

Status LogChannels::add(const TopicInfo& topic) {
  const std::lock_guard lock(mutex_);
  if (channels_.contains(topic.name)) return {};
  GLOAM_TRY(const MessageInfo type, message_info(topic.type));
  uint16_t& schema = schemas_[topic.type];
  if (schema == 0) {
    schema = static_cast<uint16_t>(schemas_.size());
    const std::string& text = type.definition;
    GLOAM_TRY_STATUS(
        queue_->push(McapSchema{schema, topic.type, "ros2msg", {text.begin(), text.end()}}));
  }
  const auto id = static_cast<uint16_t>(channels_.size() + 1);
  McapChannel channel{id, schema, topic.name, "cdr", {}};
  channel.metadata = {{"offered_qos_profiles", qos_text(topic.qos)},
                      {"topic_type_hash", type.hash}};
  GLOAM_TRY_STATUS(queue_->push(std::move(channel)));
  channels_[topic.name] = {id};
  return {};
}

void LogChannels::write(const std::string& topic, uint64_t log_time,
                        std::span<const uint8_t> data) {
  LogQueueMessage message;
  {
    const std::lock_guard lock(mutex_);
    const auto found = channels_.find(topic);
    if (found == channels_.end()) return;  // came with a recompile
    message.channel = found->second.id;
    message.sequence = found->second.sequence++;
  }
  message.log_time = message.publish_time = log_time;
  message.data = queue_->take_buffer();
  message.data.assign(data.begin(), data.end());
  static_cast<void>(queue_->push(std::move(message)));
}

}  // namespace gloam
