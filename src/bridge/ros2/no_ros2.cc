// The bridge to ROS 2 of a build without its library.

#include "bridge/bridge_list.h"

namespace gloam::bridge {

Result<std::unique_ptr<Bridge>> start_ros2(const BridgeContext&, const Ros2Options& options) {
  return Error{ErrorKind::kUsage, "this build does not include the ROS 2 bridge", options.loc,
               "run ./gloam setup to install Fast DDS and build the bridge"};
}

}  // namespace gloam::bridge
