#pragma once
// WebSocketServer: HTTP pages and WebSockets on one port, served by one thread. It enforces limits
// of size, number and time; ServerEvents decides who may connect and handles the messages.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "gloam/result.h"
#include "web/access.h"
#include "web/outbox.h"

namespace gloam::web {

struct ServerOptions {
  std::string host = "127.0.0.1";
  int port = 0;                             ///< 0 = any free one
  std::string port_hint = "try --port 0";   ///< remedy where the port is in use
  std::string methods = "GET";              ///< that status 405 lists
  int max_clients = 32;                     ///< connections of each Access
  OutboxOptions outbox;                     ///< of each client
  size_t message_bytes = size_t{1} << 20;   ///< longest message of a client with Access::kControl
  size_t watcher_bytes = size_t{16} << 10;  ///< and of one with Access::kWatch
  bool accepts_binary = true;               ///< else a binary message ends the connection
  std::chrono::milliseconds request_time{5000};  ///< for a request header or a handshake; until
                                                 ///< access is granted, less (HalfOpen)
  std::chrono::milliseconds idle_time{30000};    ///< a silent WebSocket is pinged at half of it
  std::chrono::milliseconds tick{0};             ///< ServerEvents::on_tick; 0 = none
};

/// Rights of a connection.
enum class Access : uint8_t { kNone, kWatch, kControl };

/// Answer to a request. The texts are static.
struct Answer {
  int status = 101;                ///< 101: the connection becomes a WebSocket
  std::string_view body = {};      ///< page, or one sentence that gives the reason of a refusal
  Access access = Access::kNone;   ///< kNone: refused; the connection ends after the answer
  std::string_view protocol = {};  ///< sub-protocol of the WebSocket; "" = none
  std::string_view type = "text/plain; charset=utf-8";
  std::string cookie = {};  ///< Set-Cookie; "" = none
};

/// An open WebSocket. Outlives its connection: its outbox takes nothing then.
struct Client {
  Client(int64_t number, const Answer& answer, std::function<void()> wake,
         const OutboxOptions& options)
      : id(number),
        protocol(answer.protocol),
        may_control(answer.access == Access::kControl),
        outbox(std::move(wake), options) {}
  const int64_t id;  ///< from 1
  const std::string_view protocol;
  const bool may_control;
  Outbox outbox;
};
using ClientPtr = std::shared_ptr<Client>;

/// Called on the network's thread; must not block.
class ServerEvents {
 public:
  virtual ~ServerEvents() = default;
  /// Decides on a request by its header.
  virtual Answer answer(const RequestFacts& request) = 0;
  virtual void on_open(const ClientPtr& client) = 0;
  virtual void on_text(const ClientPtr& client, std::string_view text) = 0;
  virtual void on_binary(const ClientPtr&, std::span<const uint8_t>) {}
  virtual void on_close(const ClientPtr& client) = 0;
  /// Called periodically while there are clients.
  virtual void on_tick() {}
};

class WebSocketServer {
 public:
  WebSocketServer(const ServerOptions& options, ServerEvents& events);
  ~WebSocketServer();

  /// Starts the thread. Errors: no address, port in use, no permission.
  Status listen();
  int port() const;
  /// Messages that were not sent to clients that have gone.
  int64_t dropped() const;
  /// Says goodbye to all clients and joins the thread within a second.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gloam::web
