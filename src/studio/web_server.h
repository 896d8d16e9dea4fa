#pragma once
// The network side: HTTP for the page's files, WebSocket for messages and pictures, on one thread.
// Knows who may connect and how much is bearable; knows nothing of simulations.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam::studio {

struct WebOptions {
  std::string host = "127.0.0.1";
  int port = 0;
  int max_connections = 32;  ///< of those that have shown the token
  std::string token;
  std::chrono::milliseconds request_time{5000};  ///< for a request header or a handshake; the first
                                                 ///< has less (web::HalfOpen)
  std::chrono::milliseconds idle_time{30000};    ///< a silent WebSocket is pinged at half of it
};

/// Called on the network's thread; must not block. Clients are numbered from 1.
class WebEvents {
 public:
  virtual ~WebEvents() = default;
  virtual void on_open(int64_t client) = 0;
  virtual void on_text(int64_t client, std::string_view text) = 0;
  virtual void on_close(int64_t client) = 0;
};

class WebServer {
 public:
  WebServer(const WebOptions& options, WebEvents& events);
  ~WebServer();

  /// Starts the thread. Errors: port in use, no permission.
  Status listen();

  int port() const;

  // From any thread. After stop() they do nothing.
  /// One text to one client, in order; a client that lets too many pile up is disconnected.
  void send(int64_t client, std::string text);
  /// To all clients; takes the place of a state that is not sent yet.
  void send_state(std::string text);
  /// To all clients that are not behind, and to new ones first thing; takes the place of a picture
  /// that is not sent yet.
  void send_picture(std::shared_ptr<const std::string> packet);
  /// The client has shown a picture: it may get another.
  void picture_seen(int64_t client);

  /// Says goodbye to all clients and joins the thread within a second.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gloam::studio
