#pragma once
// Messages from clients: text (JSON with an "op") and binary (an opcode, little endian), as the
// specification of Foxglove's WebSocket protocol has them. Pure functions of a stranger's bytes.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gloam/result.h"

namespace gloam::bridge::foxglove {

struct SubscribeMessage {
  struct Item {
    uint32_t id = 0;  ///< chosen by the client, sent with each message
    uint64_t channel = 0;
  };
  std::vector<Item> items;
};
struct UnsubscribeMessage {
  std::vector<uint32_t> ids;
};
/// Channels on which the client will publish.
struct AdvertiseMessage {
  struct Channel {
    uint32_t id = 0;  ///< chosen by the client
    std::string topic, encoding, schema_name;
  };
  std::vector<Channel> channels;
};
struct UnadvertiseMessage {
  std::vector<uint32_t> ids;
};
struct GetParametersMessage {
  std::vector<std::string> names;  ///< empty = all
  std::string request;             ///< comes back in the answer; "" = none
};
struct SetParametersMessage {
  struct Parameter {
    std::string name;
    nlohmann::json value;  ///< null = to be removed
  };
  std::vector<Parameter> parameters;
  std::string request;
};
struct WatchParametersMessage {
  std::vector<std::string> names;  ///< empty = all
  bool on = true;                  ///< false: no more
};
struct WatchGraphMessage {
  bool on = true;
};
struct FetchAssetMessage {
  std::string uri;
  uint32_t request = 0;
};
/// Binary. The data are a view into the message.
struct PublishMessage {
  uint32_t channel = 0;
  std::span<const uint8_t> data;
};
struct CallMessage {
  uint32_t service = 0, call = 0;
  std::string encoding;
  std::span<const uint8_t> data;
};
struct PlaybackMessage {
  bool play = false;             ///< else pause
  float speed = 1;               ///< simulated seconds per second
  std::optional<uint64_t> seek;  ///< [ns]
  std::string request;
};

using ClientMessage = std::variant<SubscribeMessage, UnsubscribeMessage, AdvertiseMessage,
                                   UnadvertiseMessage, GetParametersMessage, SetParametersMessage,
                                   WatchParametersMessage, WatchGraphMessage, FetchAssetMessage,
                                   PublishMessage, CallMessage, PlaybackMessage>;

/// Most entries in a list of a message.
inline constexpr size_t kMostItems = 4096;
inline constexpr size_t kLongestName = 1024;  // of topics, types, parameters, URIs [bytes]

/// Errors: not JSON, no known "op", a field that lacks or is of another type, numbers that are no
/// ids, lists and names that are too long.
Result<ClientMessage> parse_text_message(std::string_view text);
/// Errors: no known opcode, bytes that lack, a speed that is no number.
Result<ClientMessage> parse_binary_message(std::span<const uint8_t> bytes);

}  // namespace gloam::bridge::foxglove
