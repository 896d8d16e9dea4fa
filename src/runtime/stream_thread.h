#pragma once
// The thread of one stream: takes Snapshots out of a queue until the simulation ends, the stream is
// closed or `take` fails, and says why.

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "sim/snapshots/snapshot_queue.h"

namespace gloam {

class StreamThread {
 public:
  ~StreamThread() { close(); }

  /// Once. `take` comes on the new thread; its Error ends the stream. `what`: "lidar 'roof'", for
  /// messages; `memory_hint`: what to do when memory runs out.
  void start(std::shared_ptr<SnapshotQueue> queue, std::string what, std::string memory_hint,
             std::function<Status(const Snapshot&)> take);
  /// Waits for the call of `take` that is under way. To be called before what `take` uses goes.
  void close();
  /// Waits until the simulation has stopped and all was taken.
  void drain();
  /// Snapshots that were lost.
  int64_t dropped() const { return queue_ != nullptr ? queue_->dropped() : 0; }
  /// Error for which it takes no more, if any.
  Status status() const;

 private:
  void run(const std::string& memory_hint, const std::function<Status(const Snapshot&)>& take);
  void end(Error why);

  std::shared_ptr<SnapshotQueue> queue_;
  std::string what_;
  mutable std::mutex mutex_;
  Status status_;
  std::thread thread_;
};

}  // namespace gloam
