#pragma once
// StateStreams: "state" and "state/RATE", opened and closed on a thread of their own, since closing
// a stream waits for its last callback.

#include <memory>
#include <string>

#include "base/threads/stream_set.h"
#include "base/threads/worker.h"
#include "bridge/zmq/outbox.h"
#include "bridge/zmq/streams/state_pack.h"
#include "gloam/simulation.h"

namespace gloam::bridge::zeromq {

class StateStreams {
 public:
  StateStreams(Simulation& simulation, Outbox& outbox, StateLayouts& layouts)
      : simulation_(simulation), outbox_(outbox), layouts_(layouts) {}
  ~StateStreams() { worker_.stop(); }

  /// Any thread; never blocks. A second subscriber gets the errors of the first.
  void set_wanted(const std::string& subscription, bool is_wanted);
  int64_t dropped() const { return streams_.dropped(); }

 private:
  void open(const std::string& subscription);
  Result<std::unique_ptr<SnapshotStream>> open_stream(const std::string& subscription);
  void publish_error(const std::string& subscription, const Error& error);

  Simulation& simulation_;
  Outbox& outbox_;
  StateLayouts& layouts_;
  StreamSet streams_;  // by subscription; the worker opens and closes them
  static constexpr size_t kMaxJobs = 8192;
  Worker worker_{kMaxJobs, Overflow::kReject};  // last: its jobs use the others
};

}  // namespace gloam::bridge::zeromq
