#pragma once
// Stream: what all open streams of a simulation have in common.

#include <cstdint>
#include <functional>

#include "gloam/result.h"

namespace gloam {

/// Comes once, on the stream's own thread, when a stream ends before its simulation does: memory
/// ran out, or a recompile took its camera or sensor away. It may not destroy the stream.
using EndCallback = std::function<void(const Error& why)>;

/// An open stream. Closing (destroying) it waits for its last callback; so it must not be closed
/// from one. Any thread.
class Stream {
 public:
  virtual ~Stream() = default;
  /// Frames, scans or samples lost because the reader was slow; never those that a sensor's own
  /// model drops.
  virtual int64_t dropped() const = 0;
  /// The first step after which all is known of a message that begins at step `from` or later: the
  /// end of an exposure, of a scan. -1 = there is no one such step, as of several topics.
  virtual int64_t complete_at(int64_t from) const = 0;
  /// Waits until everything that was complete before the call has been delivered, or the stream has
  /// ended. Not from one of its callbacks.
  virtual void flush() = 0;
  /// Why it delivers no more, if so.
  virtual Status status() const = 0;
};

}  // namespace gloam
