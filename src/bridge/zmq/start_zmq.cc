// Placeholder until the bridge lands.
#include "bridge/bridge_list.h"
namespace gloam::bridge {
Result<std::unique_ptr<Bridge>> start_zmq(const BridgeContext&, const ZmqOptions& options) {
  return Error{ErrorKind::kUsage, "not there yet", options.loc};
}
}  // namespace gloam::bridge
