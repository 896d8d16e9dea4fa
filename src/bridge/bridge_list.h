#pragma once
// The table of bridges, and the things that they share.

#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "bridge/operations/operator.h"
#include "gloam/bridge.h"

namespace gloam::bridge {

/// Things that every bridge is given; they outlive it.
struct BridgeContext {
  Simulation& simulation;
  Operator& operations;
  LogPlayer* player = nullptr;  ///< of a replay; else null
  std::string token;            ///< that clients of ZeroMQ and Foxglove must know; a secret
};

Result<std::unique_ptr<Bridge>> start_ros2(const BridgeContext& context,
                                           const Ros2Options& options);
Result<std::unique_ptr<Bridge>> start_zmq(const BridgeContext& context, const ZmqOptions& options);
Result<std::unique_ptr<Bridge>> start_foxglove(const BridgeContext& context,
                                               const FoxgloveOptions& options);

/// A row of the table: the bridge's table in [bridge], the help of its flag and its start.
template <class Options>
struct BridgeRow {
  const char* name;
  const char* help;
  std::optional<Options> BridgeOptions::* options;
  Result<std::unique_ptr<Bridge>> (*start)(const BridgeContext&, const Options&);
};

/// In the order in which they start.
inline constexpr std::tuple kBridges = {
    BridgeRow<Ros2Options>{"ros2",
                           "Run as a ROS 2 node on this machine, with topics and services "
                           "(docs/ros2.md)",
                           &BridgeOptions::ros2, start_ros2},
    BridgeRow<ZmqOptions>{"zmq", "Serve states and operations over ZeroMQ (docs/zmq.md)",
                          &BridgeOptions::zmq, start_zmq},
    BridgeRow<FoxgloveOptions>{"foxglove", "Run a Foxglove server (docs/foxglove.md)",
                               &BridgeOptions::foxglove, start_foxglove},
};

}  // namespace gloam::bridge
