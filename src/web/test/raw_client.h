#pragma once
// A client by hand, so that tests can misbehave: plain sockets, HTTP and WebSocket frames. All
// reads have a time limit.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace gloam::web {

class RawClient {
 public:
  explicit RawClient(int port);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool connected() const { return socket_ >= 0; }
  bool send_bytes(std::string_view bytes);
  /// What comes until the end of the stream or `seconds` have passed.
  std::string read_all(double seconds = 3);
  /// True when the server ends the connection within `seconds`; discards what comes before.
  bool closed_within(double seconds);

  /// Status of a request with extra header lines ("Name: value\r\n"); 0 = no answer. The connection
  /// serves no second one.
  int request(std::string_view method, std::string_view target, std::string_view headers);
  const std::string& answer() const { return answer_; }

  /// Becomes a WebSocket. Returns the HTTP status: 101 when it worked.
  int upgrade(std::string_view headers, std::string_view target = "/ws");
  bool send_frame(int opcode, std::string_view payload);
  bool send_text(std::string_view text) { return send_frame(1, text); }
  bool send_json(const nlohmann::json& message) { return send_text(message.dump()); }

  struct Frame {
    int opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping
    std::string payload;
  };
  /// Next frame; empty at the end of the stream or when none comes in time. Pings are answered.
  std::optional<Frame> read_frame(double seconds = 3);
  /// Next text message of a type; others are skipped, pictures are acknowledged.
  std::optional<nlohmann::json> wait_for(std::string_view type, double seconds = 5);
  std::optional<std::string> wait_for_picture(double seconds = 5);
  /// Code of the close frame, -1 when the stream ends without one or nothing comes.
  int wait_for_close(double seconds = 5);

 private:
  bool fill(size_t bytes, double seconds);

  int socket_ = -1;
  std::string input_, answer_;
};

}  // namespace gloam::web
