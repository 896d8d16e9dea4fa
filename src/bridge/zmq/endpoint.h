#pragma once
// Endpoints: sockets bound to the addresses and keys that [bridge.zmq] asks for.

#include <memory>
#include <string>
#include <zmq.hpp>

#include "gloam/result.h"
#include "gloam/scene/bridge.h"

namespace gloam::bridge::zeromq {

/// A server's CURVE key pair in Z85.
struct CurveKey {
  std::string secret, public_key;
};
/// Reads the file of curve_keygen or a ZPL certificate. Errors: it cannot be read, others may read
/// it, no key of 40 characters in it.
Result<CurveKey> read_curve_key(const std::string& file, const SourceLoc& loc);

/// The two sockets of a bridge; they live on one thread.
struct Endpoints {
  zmq::context_t context{1};
  zmq::socket_t operations{context, zmq::socket_type::router};
  zmq::socket_t streams{context, zmq::socket_type::xpub};
  std::string operations_address, streams_address;  ///< "tcp://127.0.0.1:5556"
  int port = 0;                                     ///< of operations
  std::string public_key;                           ///< empty = no encryption

  /// Errors: a port in use, an address that is not this machine's, one beyond loopback without a
  /// key, a bad key.
  static Result<std::unique_ptr<Endpoints>> bind(const ZmqOptions& options);
};

}  // namespace gloam::bridge::zeromq
