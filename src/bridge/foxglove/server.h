#pragma once
// The network side: WebSockets of Foxglove's sub-protocols on one thread. Knows who may connect and
// how much is bearable; knows nothing of simulations.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bridge/foxglove/outbox.h"
#include "bridge/foxglove/server_messages.h"
#include "gloam/result.h"

namespace gloam::bridge::foxglove {

struct ServerOptions {
  std::string host = "127.0.0.1";
  int port = 0;          ///< 0 = any free one
  int max_clients = 32;  ///< with the token, and as many without it
  std::string token;
  OutboxLimits outbox;
  size_t message_bytes = size_t{1} << 20;        ///< longest message of a client with the token
  size_t watcher_bytes = size_t{16} << 10;       ///< and of one without, which may only subscribe
  std::chrono::milliseconds request_time{5000};  ///< for a whole request header, or a handshake
  std::chrono::milliseconds idle_time{30000};    ///< a silent client is pinged at half of it
  std::chrono::milliseconds tick{50};            ///< ServerEvents::on_tick
};

/// An open WebSocket. Outlives its connection: its outbox takes nothing then.
struct Client {
  Client(int64_t number, const ProtocolChoice& choice, bool control, std::function<void()> wake,
         const OutboxLimits& limits)
      : id(number),
        protocol(choice.protocol),
        may_control(control),
        outbox(std::move(wake), limits) {}
  const int64_t id;  ///< from 1
  const Protocol protocol;
  const bool may_control;
  Outbox outbox;
};
using ClientPtr = std::shared_ptr<Client>;

/// Called on the network's thread; must not block.
class ServerEvents {
 public:
  virtual ~ServerEvents() = default;
  virtual void on_open(const ClientPtr& client) = 0;
  virtual void on_text(const ClientPtr& client, std::string_view text) = 0;
  virtual void on_binary(const ClientPtr& client, std::span<const uint8_t> bytes) = 0;
  virtual void on_close(const ClientPtr& client) = 0;
  virtual void on_tick() = 0;
};

class Server {
 public:
  Server(const ServerOptions& options, ServerEvents& events);
  ~Server();

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

}  // namespace gloam::bridge::foxglove
