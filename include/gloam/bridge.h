#pragma once
// Bridges: sinks and sources of a running Simulation's topics and operations for other programs.
// Topics that nobody subscribes to are not computed. docs/bridges.md lists them.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/bridge.h"
#include "gloam/simulation.h"

namespace gloam {

class LogPlayer;  // gloam/log_player.h

struct BridgeStats {
  int clients = 0;           ///< present now; of ROS 2 those whose subscriptions match
  int64_t messages_out = 0;  ///< sent, one for all subscribers
  int64_t messages_in = 0;   ///< heard and obeyed
  int64_t refused = 0;       ///< heard and refused: damaged, unknown, not allowed
  int64_t dropped = 0;       ///< not sent, because the reader was slow
};

/// One connection; it ends when it is destroyed. Thread-safe.
class Bridge {
 public:
  virtual ~Bridge() = default;
  virtual std::string name() const = 0;     ///< "ros2"
  virtual std::string address() const = 0;  ///< for people: "domain 0, loopback"
  virtual BridgeStats stats() const = 0;
  /// Why it no longer works, if so.
  virtual Status status() const = 0;
};

/// All bridges of one Simulation; they share one list of spawned entities and one claim a robot.
class Bridges {
 public:
  /// Starts every bridge that `options` asks for. The Simulation and the LogPlayer, which may be
  /// null (playback is offered with one), must live longer. Errors: a port in use, a host beyond
  /// loopback without a key, a bridge that this build lacks, a bad token in GLOAM_TOKEN.
  static Result<std::unique_ptr<Bridges>> start(Simulation& simulation,
                                                const BridgeOptions& options,
                                                LogPlayer* player = nullptr);
  virtual ~Bridges() = default;
  virtual const std::vector<std::unique_ptr<Bridge>>& list() const = 0;
  /// A client has asked for the program's end.
  virtual bool end_asked() const = 0;
};

}  // namespace gloam
