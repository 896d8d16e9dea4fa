#pragma once
// The thread of one stream: takes Snapshots, or windows of them, out of a queue until the
// simulation ends, the stream is closed or `take` fails, and says why.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "gloam/stream.h"
#include "runtime/streams/sensor_costs.h"
#include "sim/snapshots/snapshot_queue.h"

namespace gloam {

struct StreamJob {
  std::string what;              ///< "lidar 'roof'", for messages
  std::string memory_hint = {};  ///< what to do when memory runs out
  /// Comes on the new thread; its Error ends the stream.
  std::function<Status(const SnapshotWindow&)> take;
  /// Where windows come from besides the queue; empty = the queue alone. An empty window ends the
  /// stream.
  std::function<SnapshotWindow()> next = {};
  /// Comes on the thread as the last thing, however the stream ended.
  std::function<void()> finish = {};
  EndCallback on_end = {};
  /// Gets the time of each call of `take`, of which `waited` tells how much passed in waiting for
  /// other sensors, over all calls [s]. `take` counts its messages itself.
  std::shared_ptr<SensorAccount> account = {};
  std::function<double()> waited = {};
};

class StreamThread {
 public:
  ~StreamThread() { close(); }

  /// Once.
  void start(std::shared_ptr<SnapshotQueue> queue, StreamJob job);
  /// Waits for the call of `take` that is under way. To be called before what `take` uses goes.
  void close();
  /// Waits until the simulation has stopped and all was taken.
  void drain();
  /// The same, for at most `time`. Whether all was taken.
  bool drain_for(std::chrono::milliseconds time);
  /// Takes nothing more, what waits included; `take` may ask is_abandoned() to return early.
  void abandon();
  bool is_abandoned() const { return is_abandoned_.load(std::memory_order_relaxed); }
  /// Windows taken so far, and whether there are no others yet.
  int64_t taken() const;
  bool is_idle() const;
  /// As Stream::flush().
  void flush();
  int64_t complete_at(int64_t from) const { return queue_->complete_at(from); }
  /// Snapshots that were lost.
  int64_t dropped() const { return queue_ != nullptr ? queue_->dropped() : 0; }
  /// Error for which it takes no more, if any.
  Status status() const;

 private:
  void run();
  Status take_all();
  Status take_timed(const SnapshotWindow& window);
  void end(Error why);

  std::shared_ptr<SnapshotQueue> queue_;
  StreamJob job_;
  std::atomic<bool> is_abandoned_{false};
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  Status status_;
  int64_t taken_ = 0;  // windows
  bool has_ended_ = false;
  std::thread thread_;
};

}  // namespace gloam
