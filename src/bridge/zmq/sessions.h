#pragma once
// Sessions: which clients are there, and the robots that each has claimed. A claim ends with its
// client: the server probes all that hold one.

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "bridge/zmq/outbox.h"
#include "gloam/simulation.h"

namespace gloam::bridge::zeromq {

/// Any thread.
class Sessions {
 public:
  explicit Sessions(Simulation& simulation) : simulation_(simulation) {}

  /// A client has shown the token.
  void note(const Envelope& client);
  /// Clients that asked for something in the last 10 s, or hold a claim.
  int count() const;

  /// Errors: no such robot, claimed already, the client holds too many.
  Status claim(const Envelope& client, const std::string& robot);
  Status release(const std::string& client, const std::string& robot);
  /// Gives back all that a client holds.
  void end(const std::string& client);
  std::vector<std::string> claims(const std::string& client) const;
  std::vector<Envelope> holders() const;

  /// Posts Commands to one robot for a client, by its lease where it has one.
  Status post(const std::string& client, const std::string& robot,
              std::span<const Command> commands);

 private:
  using Clock = std::chrono::steady_clock;
  struct Session {
    Envelope client;
    Clock::time_point last_seen;
    std::map<std::string, std::unique_ptr<ControlLease>> leases;  // by robot
  };
  void forget_silent();

  Simulation& simulation_;
  mutable std::mutex mutex_;
  std::map<std::string, Session> sessions_;  // by routing id
};

}  // namespace gloam::bridge::zeromq
