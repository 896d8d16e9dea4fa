#pragma once
// Bridges: connect other programs to the topics and operations of a running Simulation. Topics
// without subscribers are not computed. docs/bridges.md lists the bridges.

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
  int clients = 0;           ///< connected now; for ROS 2, clients with matching subscriptions
  int64_t messages_out = 0;  ///< sent; counted once for all subscribers
  int64_t messages_in = 0;   ///< received and applied
  int64_t refused = 0;       ///< received and rejected: malformed, unknown, not allowed
  int64_t dropped = 0;       ///< not sent because the reader was slow
};

/// One bridge; destroying it closes it. Thread-safe.
class Bridge {
 public:
  virtual ~Bridge() = default;
  virtual std::string name() const = 0;     ///< "ros2"
  virtual std::string address() const = 0;  ///< for display: "domain 0, loopback"
  virtual BridgeStats stats() const = 0;
  /// Reason if it no longer works.
  virtual Status status() const = 0;
};

/// A kind of bridge, for flags and listings.
struct BridgeKind {
  std::string name;  ///< "ros2", as in [bridge.ros2]
  std::string help;  ///< of its flag
  /// Requests it with default options, unless it is requested already.
  void (*request)(BridgeOptions*);
};
std::vector<BridgeKind> bridge_kinds();

/// All bridges of one Simulation. They share one list of spawned entities and one claim per robot.
class Bridges {
 public:
  /// Starts every bridge that `options` requests. With a LogPlayer (may be null) the bridges offer
  /// playback. The Simulation and the LogPlayer must outlive the bridges. Errors: a port in use, a
  /// host beyond loopback without a key, a bridge that this build lacks, an invalid token in
  /// GLOAM_TOKEN.
  static Result<std::unique_ptr<Bridges>> start(Simulation& simulation,
                                                const BridgeOptions& options,
                                                LogPlayer* player = nullptr);
  virtual ~Bridges() = default;
  virtual const std::vector<std::unique_ptr<Bridge>>& list() const = 0;
  /// Whether a client has requested the end of the program.
  virtual bool end_asked() const = 0;
};

}  // namespace gloam
