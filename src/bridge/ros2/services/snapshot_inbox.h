#pragma once
// SnapshotInbox: from the thread of a stream to one that reads when it can.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "gloam/snapshot.h"

namespace gloam::bridge {

/// Hands Snapshots over one at a time: a simulation that runs as fast as it can waits, so that
/// goals are not late.
class SnapshotInbox {
 public:
  void put(const Snapshot& snapshot) {
    std::unique_lock lock(mutex_);
    snapshot_ = snapshot;
    changed_.notify_all();
    changed_.wait(lock, [this] { return closed_ || !snapshot_; });
  }
  /// The next one; none came in a while = empty.
  Snapshot take() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(50),
                      [this] { return static_cast<bool>(snapshot_); });
    Snapshot taken;
    std::swap(taken, snapshot_);
    changed_.notify_all();
    return taken;
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Snapshot snapshot_;
  bool closed_ = false;
};

/// Before a stream closes, its last callback must return.
struct InboxCloser {
  SnapshotInbox& inbox;
  ~InboxCloser() { inbox.close(); }
};

}  // namespace gloam::bridge
