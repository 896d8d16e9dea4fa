// Placeholder until the bridge lands.
#include "bridge/bridge_list.h"
namespace gloam::bridge {
Result<std::unique_ptr<Bridge>> start_ros2(const BridgeContext&, const Ros2Options& options) {
  return Error{ErrorKind::kUsage, "not there yet", options.loc};
}
}  // namespace gloam::bridge
