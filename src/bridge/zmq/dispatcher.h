#pragma once
// Dispatcher: from a request's bytes to its reply: reads it, checks token and arguments, runs the
// operation on the server's thread or the worker's.

#include <atomic>
#include <memory>
#include <span>

#include "base/threads/worker.h"
#include "bridge/zmq/operations/operation.h"
#include "bridge/zmq/request.h"

namespace gloam::bridge::zeromq {

constexpr size_t kMostJobs = 64;  // slow operations that wait

class Dispatcher {
 public:
  Dispatcher(Services services, Outbox& outbox) : services_(std::move(services)), outbox_(outbox) {}
  ~Dispatcher() { stop(); }

  /// Never blocks for longer than a physics step.
  void dispatch(const Envelope& from, std::span<const uint8_t> bytes);
  /// Waits for the operation that runs.
  void stop() { worker_.stop(); }
  int64_t obeyed() const { return obeyed_; }
  int64_t refused() const { return refused_; }

 private:
  /// Operation that a request asks for, if its client may.
  Result<const Operation*> admit(const Envelope& from, const Request& request);
  void run(const Envelope& from, const Request& request, const Operation& operation);
  void refuse(const Envelope& from, const msgpack::object& id, const Error& error);

  Services services_;
  Outbox& outbox_;
  std::atomic<int64_t> obeyed_{0}, refused_{0};
  Worker worker_{kMostJobs, Overflow::kReject};  // last: it uses the others
};

}  // namespace gloam::bridge::zeromq
