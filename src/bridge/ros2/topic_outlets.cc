#include "bridge/ros2/topic_outlets.h"

#include <algorithm>

#include "bridge/ros2/ros2_names.h"

namespace gloam::bridge {
namespace {

using OutletClock = std::chrono::steady_clock;
// A subscriber that comes back soon finds the stream as it was, its exposure and its encoder too.
constexpr auto kCloseDelay = std::chrono::seconds(2);
constexpr int kSmallMessageDepth = 100;  // of small messages, as tf2 keeps transforms

// Compressed pictures fit a socket at once, and do not wait behind raw ones.
bool is_large_message(const TopicInfo& topic) {
  if (topic.type.find("Compressed") != std::string::npos) return false;
  for (const char* part : {"Image", "PointCloud", "Video", "EventPacket", "MarkerArray", "Scene"})
    if (topic.type.find(part) != std::string::npos) return true;
  return topic.qos.is_latched;  // a robot's description may be long
}

// A reliable writer matches both kinds of readers; a slow one loses the oldest all the same.
Result<DdsEndpoint> endpoint_of(const TopicInfo& topic) {
  GLOAM_TRY(const MessageInfo type, message_info(topic.type));
  TopicQos qos = topic.qos;
  qos.is_reliable = true;
  const bool is_large = is_large_message(topic);
  if (!is_large) qos.depth = std::max(qos.depth, kSmallMessageDepth);
  return DdsEndpoint{.topic = dds_topic(topic.name),
                     .type = type.dds_name,
                     .type_hash = type.hash,
                     .qos = qos,
                     .is_large = is_large};
}

}  // namespace

TopicOutlets::TopicOutlets(Simulation& simulation, DdsNode& node, std::function<void()> on_match)
    : simulation_(simulation), node_(node), on_match_(std::move(on_match)) {}

TopicOutlets::~TopicOutlets() {
  for (auto& [source, group] : groups_) group.stream.reset();
}

Status TopicOutlets::add(const TopicInfo& topic) {
  GLOAM_TRY(const DdsEndpoint endpoint, endpoint_of(topic));
  auto outlet = std::make_shared<Outlet>();
  outlet->topic = topic;
  GLOAM_TRY(outlet->writer, node_.add_writer(endpoint, on_match_));
  const std::lock_guard lock(mutex_);
  groups_[topic.source].outlets.emplace(topic.name, std::move(outlet));
  return {};
}

Status TopicOutlets::set_topics(const std::vector<TopicInfo>& topics) {
  const auto is_same = [](const TopicInfo& a, const TopicInfo& b) {
    return a.name == b.name && a.type == b.type && a.source == b.source;
  };
  for (auto& [source, group] : groups_) {
    group.failed.clear();
    std::vector<std::shared_ptr<Outlet>> gone;
    for (const auto& [name, outlet] : group.outlets)
      if (std::ranges::none_of(topics, [&](const auto& t) { return is_same(t, outlet->topic); }))
        gone.push_back(outlet);
    if (gone.empty()) continue;
    group.stream.reset();
    group.open.clear();
    const std::lock_guard lock(mutex_);
    for (const auto& outlet : gone) group.outlets.erase(outlet->topic.name);
  }
  for (const TopicInfo& topic : topics)
    if (!groups_[topic.source].outlets.contains(topic.name)) GLOAM_TRY_STATUS(add(topic));
  return {};
}

Status TopicOutlets::follow(Group* group) {
  std::vector<std::string> wanted;
  for (const auto& [name, outlet] : group->outlets)
    if (outlet->writer->readers() > 0) wanted.push_back(name);
  const auto now = OutletClock::now();
  const bool has_all = std::ranges::includes(group->open, wanted);
  if (has_all && wanted.size() == group->open.size()) group->wanted = now;
  if (has_all && (group->open.empty() || now - group->wanted < kCloseDelay)) return {};
  std::string names;
  for (const std::string& name : wanted) names += name + " ";
  if (!wanted.empty() && names == group->failed) return {};
  {
    const std::lock_guard lock(mutex_);
    group->stream.reset();
    group->open.clear();
  }
  group->wanted = now;
  if (wanted.empty()) return {};
  std::map<std::string, std::shared_ptr<Outlet>> outlets = group->outlets;
  const auto say = [this, outlets = std::move(outlets)](const TopicMessage& message) {
    const auto found = outlets.find(message.topic.name);
    if (found == outlets.end()) return;
    ++(found->second->writer->write(message.data) ? sent_ : lost_);
  };
  auto stream = simulation_.open_topics({.topics = wanted}, say);
  if (!stream.ok()) {
    group->failed = names;
    return stream.error();
  }
  const std::lock_guard lock(mutex_);
  group->stream = std::move(*stream);
  group->open = std::move(wanted);
  return {};
}

Status TopicOutlets::follow_subscriptions() {
  Status status;
  for (auto& [source, group] : groups_) {
    const Status followed = follow(&group);
    if (status.ok()) status = followed;
  }
  return status;
}

int TopicOutlets::subscriptions() const {
  const std::lock_guard lock(mutex_);
  int count = 0;
  for (const auto& [source, group] : groups_)
    for (const auto& [name, outlet] : group.outlets) count += outlet->writer->readers();
  return count;
}

int64_t TopicOutlets::dropped() const {
  const std::lock_guard lock(mutex_);
  int64_t count = lost_;
  for (const auto& [source, group] : groups_)
    if (group.stream != nullptr) count += group.stream->dropped();
  return count;
}

}  // namespace gloam::bridge
