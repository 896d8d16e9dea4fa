#pragma once
// A client of a Gloam simulation over ZeroMQ (docs/zmq.md), to be copied into your own program. It
// needs libzmq with cppzmq (zmq.hpp) and msgpack-cxx; C++17.

#include <functional>
#include <msgpack.hpp>
#include <stdexcept>
#include <string>
#include <vector>
#include <zmq.hpp>

namespace gloam_zmq {

using Packer = msgpack::packer<msgpack::sbuffer>;

/// An operation was refused, or the server has gone.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A server of this user on this machine, as its private file tells.
struct Server {
  std::string address;     ///< of operations, "tcp://127.0.0.1:5556"
  std::string streams;     ///< of streams
  std::string token;       ///< secret
  std::string public_key;  ///< CURVE's; empty = no encryption
};
/// The newest one. Throws Error when there is none.
Server find_server();

/// An instant.
struct State {
  int64_t step = 0;
  double time = 0;                       ///< simulation time [s]
  uint64_t hash = 0;                     ///< of the state, chained over all steps
  std::vector<double> qpos, qvel, ctrl;  ///< MuJoCo's
};

/// One thread uses it at a time.
class Client {
 public:
  explicit Client(const Server& server = find_server());

  /// Any operation; `arguments` packs `count` pairs of a map. Throws Error.
  msgpack::object_handle call(const std::string& operation, uint32_t count = 0,
                              const std::function<void(Packer&)>& arguments = {});

  void pause() { call("pause"); }
  void resume() { call("resume"); }
  /// Takes n steps of a paused run.
  State step(int64_t n);
  /// All controls of a robot, in the order of hello's list, each actuator's own unit.
  void set_controls(const std::string& robot, const std::vector<double>& values);
  /// Puts a hinge or slide joint somewhere else [rad, m].
  void set_joint(const std::string& joint, double position);

 private:
  const std::string token_;
  zmq::context_t context_;
  zmq::socket_t socket_;
  uint64_t last_id_ = 0;
};

}  // namespace gloam_zmq
