#include "bridge/foxglove/channels.h"

#include <algorithm>

#include "bridge/topic_filter.h"

namespace gloam::bridge::foxglove {

Channels::~Channels() {
  for (auto& [id, feed] : feeds_) close(feed.get());
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
  const std::lock_guard lock(mutex_);
  channels_[info.id] = {info, topic.qos.is_latched};
  return info;
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
    for (auto& [client, subscriptions] : subscriptions_)
      std::erase_if(subscriptions, [id = id](const auto& item) { return item.second == id; });
    if (const auto feed = feeds_.find(id); feed != feeds_.end()) {
      close(feed->second.get());
      feeds_.erase(feed);
    }
    const std::lock_guard lock(mutex_);
    channels_.erase(id);
  }
  // Latched messages are of the World before, and streams may have ended with it.
  for (auto& [id, feed] : feeds_) {
    if (!feed->is_latched && !feed->has_ended) continue;
    close(feed.get());
    if (const Status opened = open(feed.get()); !opened.ok())
      for (const Reader& reader : feed->readers)
        refuse_request(reader.client, counters_, opened.error().to_string());
  }
  note_subscribers();
  return change;
}

Status Channels::open(Feed* feed) {
  feed->has_ended = false;
  TopicRequest request{.topics = {feed->topic}};
  request.on_end = [feed](const Error& why) {
    feed->has_ended = true;
    const std::lock_guard lock(feed->mutex);
    for (const Reader& reader : feed->readers)
      reader.client->outbox.send(status_message(StatusLevel::kError, why.to_string()));
  };
  GLOAM_TRY(feed->stream, simulation_.open_topics(
                              request, [this, feed](const TopicMessage& m) { deliver(feed, m); }));
  return {};
}

void Channels::close(Feed* feed) {
  if (feed->stream == nullptr) return;
  dropped_ += feed->stream->dropped();
  feed->stream.reset();
}

void Channels::deliver(Feed* feed, const TopicMessage& message) {
  const std::lock_guard lock(feed->mutex);
  if (feed->readers.empty()) return;
  auto payload =
      std::make_shared<const std::vector<uint8_t>>(message.data.begin(), message.data.end());
  if (feed->is_latched) feed->latched = {message.time, payload};
  for (const Reader& reader : feed->readers) {
    Frame frame = message_data(reader.subscription, message.time, payload);
    if (feed->is_latched)
      reader.client->outbox.send(std::move(frame));
    else
      reader.client->outbox.offer(std::move(frame));
  }
  ++counters_.out;
}

void Channels::subscribe(const ClientPtr& client, const SubscribeMessage& message) {
  auto& subscriptions = subscriptions_[client->id];
  for (const SubscribeMessage::Item& item : message.items) {
    const auto channel = find(item.channel);
    const std::string id = std::to_string(item.id);
    if (!channel) {
      refuse_request(client, counters_, "there is no channel " + std::to_string(item.channel));
      continue;
    }
    if (subscriptions.contains(item.id)) {
      refuse_request(client, counters_, "subscription " + id + " is there already");
      continue;
    }
    if (std::ranges::any_of(subscriptions,
                            [&](const auto& s) { return s.second == item.channel; })) {
      refuse_request(client, counters_, "'" + channel->info.topic + "' is subscribed to already");
      continue;
    }
    std::unique_ptr<Feed>& feed = feeds_[item.channel];
    const bool is_new = feed == nullptr;
    if (is_new) feed = std::make_unique<Feed>();
    feed->topic = channel->info.topic;
    feed->is_latched = channel->is_latched;
    {
      const std::lock_guard lock(feed->mutex);
      feed->readers.push_back({client, item.id});
      if (feed->latched)
        client->outbox.send(message_data(item.id, feed->latched->first, feed->latched->second));
    }
    subscriptions[item.id] = item.channel;
    if (!is_new && !feed->has_ended) continue;
    close(feed.get());
    if (const Status opened = open(feed.get()); !opened.ok()) {
      refuse_request(client, counters_, opened.error().to_string());
      subscriptions.erase(item.id);
      remove_reader(item.channel, client);
    }
  }
  note_subscribers();
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

void Channels::remove_reader(uint64_t channel, const ClientPtr& client) {
  const auto found = feeds_.find(channel);
  if (found == feeds_.end()) return;
  Feed* const feed = found->second.get();
  bool is_last = false;
  {
    const std::lock_guard lock(feed->mutex);
    std::erase_if(feed->readers, [&](const Reader& r) { return r.client->id == client->id; });
    is_last = feed->readers.empty();
  }
  if (!is_last) return;
  close(feed);  // outside of the lock: its last callback may wait for it
  feeds_.erase(found);
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
