#include "bridge/foxglove/channels.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "bridge/topic_filter.h"

namespace gloam::bridge::foxglove {

Status Channels::open(std::mutex& announcing, std::function<void(const ChannelChange&)> on_change) {
  announcing_ = &announcing;
  on_change_ = std::move(on_change);
  GLOAM_TRY(subscription_, simulation_.subscribe(*this));
  return topics_status_;
}

std::vector<ChannelInfo> Channels::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<ChannelInfo> list;
  for (const auto& [id, info] : channels_) list.push_back(info);
  return list;
}

std::map<std::string, std::vector<int64_t>> Channels::subscribers() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::vector<int64_t>> subscribers;
  for (const auto& [topic, readers] : readers_)
    for (const Reader& reader : readers) subscribers[topic].push_back(reader.client->id);
  return subscribers;
}

void Channels::on_topics(std::span<const TopicInfo> topics) {
  bool has_lost = false;
  {
    const std::lock_guard announcing(*announcing_);
    const Result<ChannelChange> change = this->change(topics);
    topics_status_ = change.ok() ? Status() : Status(change.error());
    if (!change.ok()) {
      std::fprintf(stderr, "gloam: foxglove: %s\n", change.error().to_string().c_str());
      return;
    }
    if (!(change->added.empty() && change->removed.empty())) on_change_(*change);
    has_lost = !change->removed.empty();
  }
  if (has_lost) follow_readers();
}

Result<ChannelChange> Channels::change(std::span<const TopicInfo> topics) {
  const std::lock_guard lock(mutex_);
  ChannelChange change;
  std::map<std::string, uint64_t> gone;
  for (const auto& [id, info] : channels_) gone[info.topic + " " + info.schema.name] = id;
  for (const TopicInfo& topic : topics) {
    if (topic.is_input || !is_offered(offered_, topic.name)) continue;
    if (gone.erase(topic.name + " " + topic.type) > 0) continue;
    GLOAM_TRY(const MessageInfo type, message_info(topic.type));
    ChannelInfo info{++last_id_, topic.name, 0, {topic.type, type.definition}};
    info.schema_id = schema_ids_.emplace(topic.type, schema_ids_.size() + 1).first->second;
    channels_[info.id] = info;
    change.added.push_back(std::move(info));
  }
  for (const auto& [name, id] : gone) {
    change.removed.push_back(id);
    readers_.erase(channels_.at(id).topic);
    channels_.erase(id);
  }
  return change;
}

std::vector<Channels::Reader> Channels::readers_of(const std::string& topic) const {
  const std::lock_guard lock(mutex_);
  const auto readers = readers_.find(topic);
  return readers != readers_.end() ? readers->second : std::vector<Reader>();
}

void Channels::on_message(const TopicMessage& message) {
  const std::vector<Reader> readers = readers_of(message.topic.name);
  if (readers.empty()) return;
  const auto payload =
      std::make_shared<const std::vector<uint8_t>>(message.data.begin(), message.data.end());
  for (const Reader& reader : readers) send(reader, message, payload);
  ++counters_.out;
}

void Channels::send(const Reader& reader, const TopicMessage& message, const Payload& payload) {
  Frame frame = message_data(reader.subscription, message.time, payload);
  if (message.topic.qos.is_latched)
    reader.client->outbox.send(std::move(frame));
  else
    reader.client->outbox.offer(std::move(frame));
}

void Channels::on_error(const std::string& topic, const Error& why) {
  for (const Reader& reader : readers_of(topic))
    reader.client->outbox.send(status_message(StatusLevel::kError, why.to_string()));
}

void Channels::subscribe(const ClientPtr& client, const SubscribeMessage& message) {
  for (const SubscribeMessage::Item& item : message.items)
    if (const Status added = add_reader(client, item); !added.ok())
      refuse_request(client, counters_, added.error().to_string());
  follow_readers();
}

Status Channels::add_reader(const ClientPtr& client, const SubscribeMessage::Item& item) {
  const Reader reader{client, item.id};
  std::string topic;
  bool is_shared = false;
  {
    const std::lock_guard lock(mutex_);
    const auto found = channels_.find(item.channel);
    if (found == channels_.end())
      return Error{ErrorKind::kInput, "there is no channel " + std::to_string(item.channel)};
    for (const auto& [name, others] : readers_)
      for (const Reader& other : others)
        if (other.client->id == client->id && other.subscription == item.id)
          return Error{ErrorKind::kInput,
                       "subscription " + std::to_string(item.id) + " already exists"};
    topic = found->second.topic;
    std::vector<Reader>& readers = readers_[topic];
    if (std::ranges::any_of(readers,
                            [&](const Reader& other) { return other.client->id == client->id; }))
      return Error{ErrorKind::kInput, "'" + topic + "' already has a subscription"};
    is_shared = !readers.empty();
    readers.push_back(reader);
  }
  if (!is_shared) return {};
  subscription_->repeat(topic, [&](const TopicMessage& last) {
    send(reader, last,
         std::make_shared<const std::vector<uint8_t>>(last.data.begin(), last.data.end()));
  });
  return {};
}

template <class Fits>
size_t Channels::remove_readers(const Fits& fits) {
  const std::lock_guard lock(mutex_);
  size_t removed = 0;
  for (auto& [topic, readers] : readers_) removed += std::erase_if(readers, fits);
  std::erase_if(readers_, [](const auto& topic) { return topic.second.empty(); });
  return removed;
}

void Channels::unsubscribe(const ClientPtr& client, const UnsubscribeMessage& message) {
  for (const uint32_t id : message.ids) {
    const size_t removed = remove_readers([&](const Reader& reader) {
      return reader.client->id == client->id && reader.subscription == id;
    });
    if (removed == 0)
      refuse_request(client, counters_, "there is no subscription " + std::to_string(id));
  }
  follow_readers();
}

void Channels::leave(const ClientPtr& client) {
  remove_readers([&](const Reader& reader) { return reader.client->id == client->id; });
  follow_readers();
}

// Under the lock, so that the subscription has the topics of the last change.
void Channels::follow_readers() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> topics;
  for (const auto& [topic, readers] : readers_) topics.push_back(topic);
  subscription_->set_topics(std::move(topics));
}

}  // namespace gloam::bridge::foxglove
