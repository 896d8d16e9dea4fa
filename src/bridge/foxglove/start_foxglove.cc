#include "bridge/foxglove/foxglove_bridge.h"

namespace gloam::bridge {

Result<std::unique_ptr<Bridge>> start_foxglove(const BridgeContext& context,
                                               const FoxgloveOptions& options) {
  auto bridge = std::make_unique<foxglove::FoxgloveBridge>(context, options);
  if (Status started = bridge->start(); !started.ok()) {
    Error error = std::move(started).error();
    error.loc = options.loc;
    return error;
  }
  return std::unique_ptr<Bridge>(std::move(bridge));
}

}  // namespace gloam::bridge
