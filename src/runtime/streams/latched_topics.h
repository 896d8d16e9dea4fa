#pragma once
// LatchedTopics: messages that a reader gets once, before any others, and again in another World.

#include <functional>
#include <mutex>
#include <utility>

#include "sim/snapshots/snapshot.h"

namespace gloam {

/// Any thread. A feed owns it; the simulation knows it for as long as it lives.
class LatchedTopics {
 public:
  /// `send` sends all of them at an instant.
  explicit LatchedTopics(std::function<Status(const Snapshot&)> send) : send_(std::move(send)) {}

  Status send(const Snapshot& now) {
    const std::lock_guard lock(mutex_);
    return send_ ? send_(now) : Status();
  }
  /// Changes what `send` sends, between two calls of it.
  template <class Change>
  Status change(const Change& change) {
    const std::lock_guard lock(mutex_);
    return change();
  }
  /// Waits for a call that is under way; from now on nothing is sent.
  void close() {
    const std::lock_guard lock(mutex_);
    send_ = {};
  }

 private:
  std::mutex mutex_;
  std::function<Status(const Snapshot&)> send_;
};

}  // namespace gloam
