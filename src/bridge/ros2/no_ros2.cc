// The bridge to ROS 2 of a build without its library.

#include "bridge/bridge_list.h"

namespace gloam::bridge {

Result<std::unique_ptr<Bridge>> start_ros2(const BridgeContext&, const Ros2Options& options) {
  return Error{ErrorKind::kUsage, "this build has no bridge to ROS 2", options.loc,
               "./gloam setup installs Fast DDS and builds the bridge"};
}

}  // namespace gloam::bridge
