#include "bridge/foxglove/publishing.h"

#include <algorithm>

#include "bridge/foxglove/json_message.h"
#include "web/client_json.h"

namespace gloam::bridge::foxglove {
namespace {

constexpr size_t kMostClientChannels = 1024;

std::string names_of_inputs(const std::vector<TopicInfo>& topics) {
  std::string names;
  for (const TopicInfo& topic : topics)
    if (topic.is_input) names += (names.empty() ? "" : ", ") + topic.name;
  return names;
}

}  // namespace

std::string full_type_name(const std::string& name) {
  const size_t slash = name.find('/');
  if (slash == std::string::npos || name.find('/', slash + 1) != std::string::npos) return name;
  return name.substr(0, slash) + "/msg" + name.substr(slash);
}

Result<Publishing::ClientChannel> Publishing::check(
    const AdvertiseMessage::Channel& channel) const {
  GLOAM_TRY(const auto topics, simulation_.topics());
  const auto topic = std::ranges::find_if(
      topics, [&](const TopicInfo& t) { return t.is_input && t.name == channel.topic; });
  if (topic == topics.end())
    return Error{ErrorKind::kInput,
                 "no input topic '" + channel.topic + "'",
                 {},
                 "input topics: " + names_of_inputs(topics)};
  if (!channel.schema_name.empty() && full_type_name(channel.schema_name) != topic->type)
    return Error{ErrorKind::kInput, "'" + channel.topic + "' has type " + topic->type + ", not " +
                                        channel.schema_name};
  ClientChannel checked{channel.topic, nullptr};
  if (channel.encoding == "json") {
    GLOAM_TRY(const MessageInfo type, message_info(topic->type));
    GLOAM_TRY(auto schema, MessageSchema::parse(type.definition, topic->type));
    checked.json = std::make_shared<const MessageSchema>(std::move(schema));
  } else if (channel.encoding != "cdr") {
    return Error{ErrorKind::kInput,
                 "the encoding must be cdr or json, got '" + channel.encoding + "'"};
  }
  return checked;
}

void Publishing::advertise(const ClientPtr& client, const AdvertiseMessage& message) {
  auto& channels = clients_[client->id];
  for (const AdvertiseMessage::Channel& channel : message.channels) {
    if (channels.contains(channel.id)) {
      refuse_request(client, counters_,
                     "channel " + std::to_string(channel.id) + " is already advertised");
      continue;
    }
    if (channels.size() >= kMostClientChannels)
      return refuse_request(client, counters_, "too many channels");
    auto checked = check(channel);
    if (checked.ok())
      channels[channel.id] = *std::move(checked);
    else
      refuse_request(client, counters_, checked.error().to_string());
  }
}

void Publishing::unadvertise(const ClientPtr& client, const UnadvertiseMessage& message) {
  auto& channels = clients_[client->id];
  for (const uint32_t id : message.ids)
    if (channels.erase(id) == 0)
      refuse_request(client, counters_, "channel " + std::to_string(id) + " is not advertised");
}

void Publishing::publish(const ClientPtr& client, const PublishMessage& message) {
  const auto& channels = clients_[client->id];
  const auto found = channels.find(message.channel);
  if (found == channels.end())
    return refuse_request(client, counters_,
                          "channel " + std::to_string(message.channel) + " is not advertised");
  const ClientChannel& channel = found->second;
  Status status;
  if (channel.json == nullptr) {
    status = simulation_.publish(channel.topic, message.data);
  } else {
    const auto object = web::parse_client_json(
        {reinterpret_cast<const char*>(message.data.data()), message.data.size()});
    const auto bytes = cdr_from_json(*channel.json, object);
    status = bytes.ok() ? simulation_.publish(channel.topic, *bytes) : Status(bytes.error());
  }
  if (!status.ok())
    return refuse_request(client, counters_, channel.topic + ": " + status.error().to_string());
  ++counters_.in;
}

std::map<std::string, std::vector<int64_t>> Publishing::publishers() const {
  std::map<std::string, std::vector<int64_t>> publishers;
  for (const auto& [client, channels] : clients_)
    for (const auto& [id, channel] : channels) publishers[channel.topic].push_back(client);
  return publishers;
}

}  // namespace gloam::bridge::foxglove
