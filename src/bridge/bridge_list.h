#pragma once
// The list of bridges: one function each, and what they share.

#include <memory>
#include <string>

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

}  // namespace gloam::bridge
