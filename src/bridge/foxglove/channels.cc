#include "bridge/foxglove/channels.h"

#include <algorithm>
#include <thread>

#include "bridge/topic_filter.h"

namespace gloam::bridge::foxglove {

// All at once: cameras that still run would keep the renderer from the one that is closed.
Channels::~Channels() {
  std::vector<std::thread> closing;
  for (auto& [key, feed] : feeds_)
    if (feed->stream != nullptr) closing.emplace_back([this, feed = feed.get()] { close(feed); });
  for (std::thread& thread : closing) thread.join();
}

std::vector<ChannelInfo> Channels::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<ChannelInfo> list;
  for (const auto& [id, channel] : channels_) list.push_back(channel.info);
  return list;
}

std::map<std::string, std::vector<int64_t>> Channels::subscribers() const {
  const std::lock_guard lock(mutex_);
  return subscribers_;
}

std::optional<Channels::Channel> Channels::find(uint64_t id) const {
  const std::lock_guard lock(mutex_);
  const auto found = channels_.find(id);
  if (found == channels_.end()) return {};
  return found->second;
}

ChannelInfo Channels::add_channel(const TopicInfo& topic, const MessageInfo& type) {
  ChannelInfo info{++last_id_, topic.name, 0, {topic.type, type.definition}};
  info.schema_id = schema_ids_.emplace(topic.type, schema_ids_.size() + 1).first->second;
  const bool is_camera = topic.source.starts_with("camera ") && !topic.qos.is_latched;
  const std::lock_guard lock(mutex_);
  channels_[info.id] = {info, topic.qos.is_latched, is_camera ? topic.source : topic.name};
  return info;
}

void Channels::remove_channel(uint64_t id) {
  const auto channel = find(id);
  for (auto& [client, subscriptions] : subscriptions_)
    std::erase_if(subscriptions, [id](const auto& item) { return item.second == id; });
  if (const auto feed = feeds_.find(channel->feed); feed != feeds_.end()) {
    const std::lock_guard lock(feed->second->mutex);
    feed->second->outlets.erase(channel->info.topic);
  }
  const std::lock_guard lock(mutex_);
  channels_.erase(id);
}

Result<ChannelChange> Channels::follow() {
  const auto world = simulation_.world().compiled();
  if (world == world_) return ChannelChange{};
  GLOAM_TRY(const auto topics, simulation_.topics());
  world_ = world;
  ChannelChange change;
  std::map<std::string, uint64_t> present;
  for (const ChannelInfo& info : list()) present[info.topic + " " + info.schema.name] = info.id;
  for (const TopicInfo& topic : topics) {
    if (topic.is_input || !is_offered(offered_, topic.name)) continue;
    if (present.erase(topic.name + " " + topic.type) > 0) continue;
    GLOAM_TRY(const MessageInfo type, message_info(topic.type));
    change.added.push_back(add_channel(topic, type));
  }
  for (const auto& [name, id] : present) {
    change.removed.push_back(id);
    remove_channel(id);
  }
  // Latched messages are of the World before, and streams may have ended with it.
  for (auto& [key, feed] : feeds_) {
    const std::lock_guard lock(feed->mutex);
    const bool is_latched = std::ranges::any_of(
        feed->outlets, [](const auto& outlet) { return outlet.second.is_latched; });
    if (is_latched) feed->has_ended = true;
  }
  note_subscribers();
  return change;
}

void Channels::settle() {
  for (auto& [key, feed] : feeds_) settle(feed.get());
  std::erase_if(feeds_, [](const auto& item) { return item.second->outlets.empty(); });
}

void Channels::settle(Feed* feed) {
  std::vector<std::string> wanted;
  {
    const std::lock_guard lock(feed->mutex);
    for (const auto& [topic, outlet] : feed->outlets) wanted.push_back(topic);
  }
  if (wanted == feed->open_topics && !feed->has_ended) return;
  close(feed);  // outside of the lock: its last callback may wait for it
  feed->has_ended = false;
  feed->open_topics = wanted;
  if (wanted.empty()) return;
  TopicRequest request{.topics = wanted};
  request.on_end = [feed](const Error& why) {
    feed->has_ended = true;
    tell_readers(feed, why);
  };
  auto stream = simulation_.open_topics(
      request, [this, feed](const TopicMessage& message) { deliver(feed, message); });
  if (stream.ok())
    feed->stream = *std::move(stream);
  else
    tell_readers(feed, stream.error());
}

void Channels::close(Feed* feed) {
  if (feed->stream == nullptr) return;
  dropped_ += feed->stream->dropped();
  feed->stream.reset();
}

void Channels::tell_readers(Feed* feed, const Error& why) {
  const std::lock_guard lock(feed->mutex);
  for (const auto& [topic, outlet] : feed->outlets)
    for (const Reader& reader : outlet.readers)
      reader.client->outbox.send(status_message(StatusLevel::kError, why.to_string()));
}

void Channels::deliver(Feed* feed, const TopicMessage& message) {
  const std::lock_guard lock(feed->mutex);
  const auto found = feed->outlets.find(message.topic.name);
  if (found == feed->outlets.end() || found->second.readers.empty()) return;
  Outlet& outlet = found->second;
  auto payload =
      std::make_shared<const std::vector<uint8_t>>(message.data.begin(), message.data.end());
  if (outlet.is_latched) outlet.latched = {message.time, payload};
  for (const Reader& reader : outlet.readers) {
    Frame frame = message_data(reader.subscription, message.time, payload);
    if (outlet.is_latched)
      reader.client->outbox.send(std::move(frame));
    else
      reader.client->outbox.offer(std::move(frame));
  }
  ++counters_.out;
}

void Channels::subscribe(const ClientPtr& client, const SubscribeMessage& message) {
  for (const SubscribeMessage::Item& item : message.items)
    if (const Status added = add_reader(client, item); !added.ok())
      refuse_request(client, counters_, added.error().to_string());
  note_subscribers();
}

Status Channels::add_reader(const ClientPtr& client, const SubscribeMessage::Item& item) {
  auto& subscriptions = subscriptions_[client->id];
  const auto channel = find(item.channel);
  if (!channel)
    return Error{ErrorKind::kInput, "there is no channel " + std::to_string(item.channel)};
  if (subscriptions.contains(item.id))
    return Error{ErrorKind::kInput, "subscription " + std::to_string(item.id) + " already exists"};
  const auto is_same = [&](const auto& subscription) {
    return subscription.second == item.channel;
  };
  if (std::ranges::any_of(subscriptions, is_same))
    return Error{ErrorKind::kInput, "'" + channel->info.topic + "' already has a subscription"};
  subscriptions[item.id] = item.channel;
  std::unique_ptr<Feed>& feed = feeds_[channel->feed];
  if (feed == nullptr) feed = std::make_unique<Feed>();
  const std::lock_guard lock(feed->mutex);
  Outlet& outlet = feed->outlets[channel->info.topic];
  outlet.is_latched = channel->is_latched;
  outlet.readers.push_back({client, item.id});
  if (outlet.is_latched && !outlet.latched) feed->has_ended = true;  // it is published again
  if (outlet.latched)
    client->outbox.send(message_data(item.id, outlet.latched->first, outlet.latched->second));
  return {};
}

void Channels::unsubscribe(const ClientPtr& client, const UnsubscribeMessage& message) {
  auto& subscriptions = subscriptions_[client->id];
  for (const uint32_t id : message.ids) {
    const auto found = subscriptions.find(id);
    if (found == subscriptions.end()) {
      refuse_request(client, counters_, "there is no subscription " + std::to_string(id));
      continue;
    }
    remove_reader(found->second, client);
    subscriptions.erase(found);
  }
  note_subscribers();
}

void Channels::leave(const ClientPtr& client) {
  const auto found = subscriptions_.find(client->id);
  if (found == subscriptions_.end()) return;
  for (const auto& [id, channel] : found->second) remove_reader(channel, client);
  subscriptions_.erase(found);
  note_subscribers();
}

void Channels::remove_reader(uint64_t id, const ClientPtr& client) {
  const auto channel = find(id);
  const auto feed = channel ? feeds_.find(channel->feed) : feeds_.end();
  if (feed == feeds_.end()) return;
  const std::lock_guard lock(feed->second->mutex);
  auto& outlets = feed->second->outlets;
  const auto outlet = outlets.find(channel->info.topic);
  if (outlet == outlets.end()) return;
  std::erase_if(outlet->second.readers,
                [&](const Reader& reader) { return reader.client->id == client->id; });
  if (outlet->second.readers.empty()) outlets.erase(outlet);
}

void Channels::note_subscribers() {
  std::map<std::string, std::vector<int64_t>> by_topic;
  for (const auto& [client, subscriptions] : subscriptions_)
    for (const auto& [id, channel] : subscriptions)
      if (const auto found = find(channel)) by_topic[found->info.topic].push_back(client);
  const std::lock_guard lock(mutex_);
  subscribers_ = std::move(by_topic);
}

}  // namespace gloam::bridge::foxglove
