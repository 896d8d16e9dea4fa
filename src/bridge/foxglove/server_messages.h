#pragma once
// Messages to clients, of all versions of Foxglove's WebSocket protocol that are spoken here.

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "web/outbox.h"

namespace gloam::bridge::foxglove {

using web::Frame;

/// Differs in how channels are advertised: with their schemas, or beside a list of schemas.
enum class Protocol : uint8_t {
  kV1,   ///< foxglove.sdk.v1, foxglove.websocket.v1
  kV11,  ///< foxglove.sdk.v1.1
};

/// Sub-protocol of a WebSocket that the client asks for first among those that this server speaks.
struct ProtocolChoice {
  std::string_view name;
  Protocol protocol = Protocol::kV1;
};
std::optional<ProtocolChoice> choose_protocol(std::string_view offered);

/// Schema of channels and of services' requests and responses.
struct Schema {
  std::string name;  ///< "sensor_msgs/msg/Imu"
  std::string text;  ///< ros2msg
};
/// A topic that clients can subscribe to.
struct ChannelInfo {
  uint64_t id = 0;
  std::string topic;
  uint64_t schema_id = 0;  ///< of a type of messages, for as long as the server runs
  Schema schema;
};
struct ServiceInfo {
  uint32_t id = 0;
  std::string name, type;  ///< "/pause", "std_srvs/srv/Trigger"
  Schema request, response;
};
/// Time range of a log that is played.
struct PlaybackRange {
  double end = 0;  ///< [s]; it begins at 0
};

Frame server_info(std::string_view session, std::optional<PlaybackRange> playback);
Frame advertise(std::span<const ChannelInfo> channels, Protocol protocol);
Frame unadvertise(std::span<const uint64_t> channels);
Frame advertise_services(std::span<const ServiceInfo> services);

enum class StatusLevel : uint8_t { kInfo, kWarning, kError };
Frame status_message(StatusLevel level, std::string_view text);

/// `request` = "" : asked by no request.
Frame parameter_values(nlohmann::json parameters, std::string_view request);
Frame connection_graph(nlohmann::json graph);
Frame service_failure(uint32_t service, uint32_t call, std::string_view message);

using Payload = std::shared_ptr<const std::vector<uint8_t>>;
/// `time` [s], of the simulation.
Frame message_data(uint32_t subscription, double time, Payload payload);
Frame time_message(double time);
Frame service_response(uint32_t service, uint32_t call, std::string_view encoding, Payload payload);
/// An asset; without one the error is sent.
Frame asset_response(uint32_t request, Payload asset, std::string_view error);

enum class PlaybackStatus : uint8_t { kPlaying, kPaused, kBuffering, kEnded };
struct PlaybackState {
  PlaybackStatus status = PlaybackStatus::kPaused;
  double time = 0;  ///< [s]
  float speed = 1;
  bool did_seek = false;
  std::string request;  ///< that it answers; "" = none
};
Frame playback_state(const PlaybackState& state);

/// Nanoseconds of a time [s], to the nearest; those before 0 are 0.
uint64_t nanoseconds(double time);

}  // namespace gloam::bridge::foxglove
