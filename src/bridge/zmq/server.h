#pragma once
// Server: the thread that owns both sockets. It never waits for a client: what a client does not
// take is dropped and counted.

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "bridge/zmq/endpoint.h"
#include "bridge/zmq/outbox.h"
#include "gloam/result.h"

namespace gloam::bridge::zeromq {

/// Calls on the server's thread; none may block.
struct ServerEvents {
  std::function<void(const Envelope& from, std::span<const uint8_t> request)> on_request;
  std::function<void(const std::string& topic, bool subscribed)> on_subscription;
  std::function<void(const std::string& client)> on_gone;
  /// Clients that must be told apart from the dead: each gets an {event: "alive"} a second.
  std::function<std::vector<Envelope>()> watched;
};

struct ServerCounts {
  std::atomic<int64_t> sent{0}, requests{0}, malformed{0}, dropped{0};
};

class Server {
 public:
  Server(std::unique_ptr<Endpoints> endpoints, Outbox& outbox, ServerEvents events);
  ~Server() { stop(); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void start();
  /// Joins the thread and closes the sockets.
  void stop();
  /// Why it no longer works, if so.
  Status status() const;
  const ServerCounts& counts() const { return counts_; }

 private:
  void run();
  void receive_requests();
  void receive_subscriptions();
  void send_replies();
  void send_publications();
  void probe_clients();
  bool send_to(const Envelope& to, const PackBuffer& payload);

  std::unique_ptr<Endpoints> endpoints_;
  Outbox& outbox_;
  const ServerEvents events_;
  ServerCounts counts_;
  std::atomic<bool> stopping_{false};
  mutable std::mutex mutex_;
  Status status_;
  std::thread thread_;
};

}  // namespace gloam::bridge::zeromq
