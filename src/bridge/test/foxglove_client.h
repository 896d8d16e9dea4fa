#pragma once
// A client by hand, so that tests can misbehave: a plain socket, the handshake, WebSocket frames.
// All reads have a time limit.

#include <cstdint>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gloam::bridge::foxglove {

class FoxgloveClient {
 public:
  explicit FoxgloveClient(int port);
  ~FoxgloveClient();
  FoxgloveClient(const FoxgloveClient&) = delete;
  FoxgloveClient& operator=(const FoxgloveClient&) = delete;

  bool send_bytes(std::string_view bytes);
  /// Becomes a WebSocket; the HTTP status: 101 when it worked. `headers`: "Name: value\r\n" each,
  /// besides those that every client sends.
  int upgrade(std::string_view target, std::string_view protocols, std::string_view headers = "");
  const std::string& answer() const { return answer_; }

  bool send_frame(int opcode, std::string_view payload);
  bool send_json(const nlohmann::json& message) { return send_frame(1, message.dump()); }

  struct Frame {
    int opcode = 0;  ///< 1 text, 2 binary, 8 close
    std::string payload;
  };
  /// Next frame but pings, which are answered; empty at the end or when none comes in time.
  std::optional<Frame> read_frame(double seconds = 5);
  /// Next text message with this "op"; others are skipped.
  std::optional<nlohmann::json> wait_for(std::string_view op, double seconds = 10);
  /// Next binary message with this opcode, without it.
  std::optional<std::string> wait_for_binary(uint8_t opcode, double seconds = 10);
  /// The same of a subscription's data: the payload behind id and time.
  std::optional<std::string> wait_for_data(uint32_t subscription, double seconds = 10);
  /// True when the server ends the connection within `seconds`.
  bool closed_within(double seconds);

 private:
  std::optional<Frame> find(const std::function<bool(const Frame&)>& fits, double seconds);
  bool fill(size_t bytes, double seconds);

  int socket_ = -1;
  std::string input_, answer_;
};

/// A number out of a binary message.
template <class T>
T number_at(std::string_view bytes, size_t at) {
  T value = {};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}
template <class T>
std::string as_bytes(T value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace gloam::bridge::foxglove
