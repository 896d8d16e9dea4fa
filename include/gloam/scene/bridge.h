#pragma once
// [bridge]: connections of a live simulation to other programs (gloam/bridge.h, docs/bridges.md).
// Part of gloam/scene.h. Tokens are no options: a scene is copied into every log.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// [bridge.ros2]: a node on ROS 2's wire, with no ROS installed (docs/ros2.md).
struct Ros2Options {
  /// DDS domain, 0 … 232; empty = the environment's ROS_DOMAIN_ID, else 0.
  std::optional<int> domain = {};
  bool network = false;        ///< on all network cards; else on loopback alone
  std::string node = "gloam";  ///< name of the node
  /// Namespace of the node, its services and parameters, "/sim"; topics stay as they are.
  std::string ns = "";
  /// Topics by name that are offered; * stands for any text. Empty = all.
  std::vector<std::string> topics = {};
  /// Shapes of simulation_interfaces: 2 (2.x) or 1 (those of Humble, Jazzy and Kilted).
  int interfaces = 2;
  SourceLoc loc = {};
};

/// [bridge.zmq]: states and operations over ZeroMQ, as msgpack (docs/zmq.md).
struct ZmqOptions {
  std::string host = "127.0.0.1";  ///< address to listen on; beyond loopback CURVE is required
  int port = 5556;                 ///< of operations; streams have the next one; 0 = any free two
  /// File of the server's CURVE secret key, as `zmq_keygen` writes it; empty = no encryption.
  std::string curve_secret = "";
  bool shared_memory = true;  ///< pictures go through shared memory to clients on this machine
  SourceLoc loc = {};
};

/// [bridge.foxglove]: a server for Foxglove and its like (docs/foxglove.md).
struct FoxgloveOptions {
  std::string host = "127.0.0.1";  ///< address to listen on
  int port = 8765;                 ///< 0 = any free one
  int max_clients = 32;            ///< open connections, 1 … 1024
  /// Topics by name that are offered; * stands for any text. Empty = all.
  std::vector<std::string> topics = {};
  SourceLoc loc = {};
};

/// [bridge]: each table that stands is a bridge of live runs.
struct BridgeOptions {
  std::optional<Ros2Options> ros2 = {};          ///< ROS 2
  std::optional<ZmqOptions> zmq = {};            ///< ZeroMQ
  std::optional<FoxgloveOptions> foxglove = {};  ///< Foxglove
  SourceLoc loc = {};

  bool any() const { return ros2 || zmq || foxglove; }
};

}  // namespace gloam
