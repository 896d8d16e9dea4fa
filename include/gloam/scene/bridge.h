#pragma once
// [bridge]: connections of a live simulation to other programs (gloam/bridge.h, docs/bridges.md).
// Part of gloam/scene.h. Tokens are not options, because every log contains a copy of the scene.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// [bridge.ros2]: a ROS 2 node, with no ROS installed (docs/ros2.md).
struct Ros2Options {
  /// DDS domain, 0 … 232; empty = the environment's ROS_DOMAIN_ID, else 0.
  std::optional<int> domain = {};
  bool network = false;        ///< true: use all network interfaces; false: loopback only
  std::string node = "gloam";  ///< name of the node
  /// Namespace of the node, its services and parameters, e.g. "/sim"; does not apply to topics.
  std::string ns = "";
  /// Names of the topics to offer; * matches any text. Empty = all.
  std::vector<std::string> topics = {};
  /// Version of simulation_interfaces: 2 (2.x) or 1 (1.x, in Humble, Jazzy and Kilted).
  int interfaces = 2;
  SourceLoc loc = {};
};

/// [bridge.zmq]: states and operations over ZeroMQ, as msgpack (docs/zmq.md).
struct ZmqOptions {
  std::string host =
      "127.0.0.1";  ///< address to listen on; addresses other than loopback require CURVE
  int port = 5556;  ///< port for operations; streams use the next one; 0 = any two free ports
  /// File with the server's CURVE secret key, as written by `zmq_keygen`; empty = no encryption.
  std::string curve_secret = "";
  bool shared_memory = true;  ///< send images to clients on this machine through shared memory
  SourceLoc loc = {};
};

/// [bridge.foxglove]: a server for Foxglove and compatible clients (docs/foxglove.md).
struct FoxgloveOptions {
  std::string host = "127.0.0.1";  ///< address to listen on
  int port = 8765;                 ///< 0 = any free port
  int max_clients = 32;            ///< limit of open connections, 1 … 1024
  /// Names of the topics to offer; * matches any text. Empty = all.
  std::vector<std::string> topics = {};
  SourceLoc loc = {};
};

/// [bridge]: bridges of live runs, one for each given table.
struct BridgeOptions {
  std::optional<Ros2Options> ros2 = {};          ///< ROS 2
  std::optional<ZmqOptions> zmq = {};            ///< ZeroMQ
  std::optional<FoxgloveOptions> foxglove = {};  ///< Foxglove
  SourceLoc loc = {};

  bool any() const { return ros2 || zmq || foxglove; }
};

}  // namespace gloam
