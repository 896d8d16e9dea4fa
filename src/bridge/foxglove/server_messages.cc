#include "bridge/foxglove/server_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>

namespace gloam::bridge::foxglove {
namespace {

using nlohmann::json;

// Names come from people's models and need not be UTF-8.
Frame text_frame(const json& message) {
  return {message.dump(-1, ' ', false, json::error_handler_t::replace), nullptr, true};
}

constexpr std::array<ProtocolChoice, 3> kProtocols = {{
    {"foxglove.sdk.v1.1", Protocol::kV11},
    {"foxglove.sdk.v1", Protocol::kV1},
    {"foxglove.websocket.v1", Protocol::kV1},
}};

enum ServerOpcode : uint8_t {
  kMessageData = 1,
  kTime = 2,
  kServiceResponse = 3,
  kAssetResponse = 4,
  kPlaybackState = 5,
};

class ByteWriter {
 public:
  explicit ByteWriter(ServerOpcode opcode) { put(static_cast<uint8_t>(opcode)); }
  template <class T>
  ByteWriter& put(T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    frame_.head.append(bytes, sizeof value);
    return *this;
  }
  ByteWriter& put_text(std::string_view text) {
    put(static_cast<uint32_t>(text.size()));
    frame_.head += text;
    return *this;
  }
  Frame finish(Payload body = nullptr) {
    frame_.body = std::move(body);
    return std::move(frame_);
  }

 private:
  Frame frame_;
};

json time_of(double time) {
  const uint64_t ns = nanoseconds(time);
  return {{"sec", ns / 1'000'000'000}, {"nsec", ns % 1'000'000'000}};
}

json message_schema(const Schema& schema) {
  return {{"encoding", "cdr"},
          {"schemaName", schema.name},
          {"schemaEncoding", "ros2msg"},
          {"schema", schema.text}};
}

}  // namespace

std::optional<ProtocolChoice> choose_protocol(std::string_view offered) {
  while (!offered.empty()) {
    const size_t comma = std::min(offered.find(','), offered.size());
    std::string_view name = offered.substr(0, comma);
    offered.remove_prefix(std::min(comma + 1, offered.size()));
    while (!name.empty() && (name.front() == ' ' || name.front() == '\t')) name.remove_prefix(1);
    while (!name.empty() && (name.back() == ' ' || name.back() == '\t')) name.remove_suffix(1);
    for (const ProtocolChoice& choice : kProtocols)
      if (choice.name == name) return choice;
  }
  return {};
}

Frame server_info(std::string_view session, std::optional<PlaybackRange> playback) {
  json message = {{"op", "serverInfo"},
                  {"name", "Gloam"},
                  {"capabilities",
                   {"time", "clientPublish", "parameters", "parametersSubscribe", "services",
                    "connectionGraph", "assets"}},
                  {"supportedEncodings", {"cdr", "json"}},
                  {"metadata", {{"ROS_DISTRO", "jazzy"}}},  // Foxglove publishes ROS 2 types then
                  {"sessionId", session}};
  if (playback) {
    message["capabilities"].push_back("playbackControl");
    message["dataStartTime"] = time_of(0);
    message["dataEndTime"] = time_of(playback->end);
  }
  return text_frame(message);
}

Frame advertise(std::span<const ChannelInfo> channels, Protocol protocol) {
  json message = {{"op", "advertise"}, {"channels", json::array()}};
  std::set<uint64_t> schemas;
  if (protocol == Protocol::kV11) message["schemas"] = json::array();
  for (const ChannelInfo& channel : channels) {
    json item = {{"id", channel.id}, {"topic", channel.topic}, {"encoding", "cdr"}};
    if (protocol == Protocol::kV11) {
      if (schemas.insert(channel.schema_id).second)
        message["schemas"].push_back({{"id", channel.schema_id},
                                      {"name", channel.schema.name},
                                      {"encoding", "ros2msg"},
                                      {"data", channel.schema.text}});
      item["schemaId"] = channel.schema_id;
    } else {
      item["schemaName"] = channel.schema.name;
      item["schemaEncoding"] = "ros2msg";
      item["schema"] = channel.schema.text;
    }
    message["channels"].push_back(std::move(item));
  }
  return text_frame(message);
}

Frame unadvertise(std::span<const uint64_t> channels) {
  return text_frame({{"op", "unadvertise"},
                     {"channelIds", std::vector<uint64_t>(channels.begin(), channels.end())}});
}

Frame advertise_services(std::span<const ServiceInfo> services) {
  json list = json::array();
  for (const ServiceInfo& service : services)
    list.push_back({{"id", service.id},
                    {"name", service.name},
                    {"type", service.type},
                    {"request", message_schema(service.request)},
                    {"response", message_schema(service.response)},
                    // Clients of foxglove.websocket.v1 read these.
                    {"requestSchema", service.request.text},
                    {"responseSchema", service.response.text}});
  return text_frame({{"op", "advertiseServices"}, {"services", std::move(list)}});
}

Frame status_message(StatusLevel level, std::string_view text) {
  return text_frame({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", text}});
}

Frame parameter_values(json parameters, std::string_view request) {
  json message = {{"op", "parameterValues"}, {"parameters", std::move(parameters)}};
  if (!request.empty()) message["id"] = request;
  return text_frame(message);
}

Frame connection_graph(json graph) {
  graph["op"] = "connectionGraphUpdate";
  return text_frame(graph);
}

Frame service_failure(uint32_t service, uint32_t call, std::string_view message) {
  return text_frame({{"op", "serviceCallFailure"},
                     {"serviceId", service},
                     {"callId", call},
                     {"message", message}});
}

Frame message_data(uint32_t subscription, double time, Payload payload) {
  return ByteWriter(kMessageData)
      .put(subscription)
      .put(nanoseconds(time))
      .finish(std::move(payload));
}

Frame time_message(double time) { return ByteWriter(kTime).put(nanoseconds(time)).finish(); }

Frame service_response(uint32_t service, uint32_t call, std::string_view encoding,
                       Payload payload) {
  return ByteWriter(kServiceResponse)
      .put(service)
      .put(call)
      .put_text(encoding)
      .finish(std::move(payload));
}

Frame asset_response(uint32_t request, Payload asset, std::string_view error) {
  const bool ok = asset != nullptr;
  return ByteWriter(kAssetResponse)
      .put(request)
      .put(static_cast<uint8_t>(ok ? 0 : 1))
      .put_text(ok ? "" : error)
      .finish(std::move(asset));
}

Frame playback_state(const PlaybackState& state) {
  return ByteWriter(kPlaybackState)
      .put(static_cast<uint8_t>(state.status))
      .put(nanoseconds(state.time))
      .put(state.speed)
      .put(static_cast<uint8_t>(state.did_seek))
      .put_text(state.request)
      .finish();
}

uint64_t nanoseconds(double time) {
  return time > 0 ? static_cast<uint64_t>(std::llround(time * 1e9)) : 0;
}

}  // namespace gloam::bridge::foxglove
