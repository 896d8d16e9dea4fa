// The bridge to ZeroMQ of a build without its library.

#include "bridge/bridge_list.h"

namespace gloam::bridge {

Result<std::unique_ptr<Bridge>> start_zmq(const BridgeContext&, const ZmqOptions& options) {
  return Error{
      ErrorKind::kUsage, "this build does not include the ZeroMQ bridge", options.loc,
      "install libzmq3-dev, cppzmq-dev and libmsgpack-cxx-dev and rebuild, or run ./gloam setup"};
}

}  // namespace gloam::bridge
