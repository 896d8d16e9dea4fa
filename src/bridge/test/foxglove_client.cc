#include "foxglove_client.h"

#include <chrono>

namespace gloam::bridge::foxglove {

int FoxgloveClient::upgrade(std::string_view target, std::string_view protocols,
                            std::string_view headers) {
  std::string all(headers);
  if (headers.find("Host:") == std::string_view::npos) all += "Host: 127.0.0.1\r\n";
  if (!protocols.empty()) all += "Sec-WebSocket-Protocol: " + std::string(protocols) + "\r\n";
  return RawClient::upgrade(all, target);
}

std::optional<FoxgloveClient::Frame> FoxgloveClient::find(
    const std::function<bool(const Frame&)>& fits, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const auto left = [&] {
    return std::chrono::duration<double>(end - std::chrono::steady_clock::now()).count();
  };
  while (auto frame = read_frame(left()))
    if (fits(*frame)) return frame;
  return {};
}

std::optional<nlohmann::json> FoxgloveClient::wait_for(std::string_view op, double seconds) {
  nlohmann::json message;
  const auto found = find(
      [&](const Frame& frame) {
        if (frame.opcode != 1) return false;
        message = nlohmann::json::parse(frame.payload);
        return message["op"] == op;
      },
      seconds);
  if (!found) return {};
  return message;
}

std::optional<std::string> FoxgloveClient::wait_for_binary(uint8_t opcode, double seconds) {
  const auto found = find(
      [&](const Frame& frame) {
        return frame.opcode == 2 && !frame.payload.empty() &&
               static_cast<uint8_t>(frame.payload[0]) == opcode;
      },
      seconds);
  if (!found) return {};
  return found->payload.substr(1);
}

std::optional<std::string> FoxgloveClient::wait_for_data(uint32_t subscription, double seconds) {
  const auto found = find(
      [&](const Frame& frame) {
        return frame.opcode == 2 && frame.payload.size() >= 13 && frame.payload[0] == 1 &&
               number_at<uint32_t>(frame.payload, 1) == subscription;
      },
      seconds);
  if (!found) return {};
  return found->payload.substr(13);
}

}  // namespace gloam::bridge::foxglove
