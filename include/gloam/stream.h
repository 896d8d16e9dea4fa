#pragma once
// Stream: common interface of all open streams of a simulation.

#include <cstdint>
#include <functional>

#include "gloam/result.h"

namespace gloam {

/// Called once, on the stream's own thread, if a stream ends before its simulation: memory ran out,
/// or a recompile removed its camera or sensor. It must not destroy the stream.
using EndCallback = std::function<void(const Error& why)>;

/// An open stream. Closing (destroying) it waits for its last callback, so a callback must not
/// close it. Any thread.
class Stream {
 public:
  virtual ~Stream() = default;
  /// Frames, scans or samples lost because the reader was slow, not including losses of a sensor's
  /// own model.
  virtual int64_t dropped() const = 0;
  /// The first step that completes a message that begins at step `from` or later: the end of an
  /// exposure or scan. -1 = no single such step, for example with several topics.
  virtual int64_t complete_at(int64_t from) const = 0;
  /// Waits until every message that was complete before the call has been delivered, or the stream
  /// has ended. Must not be called from its callbacks.
  virtual void flush() = 0;
  /// Reason if it no longer delivers.
  virtual Status status() const = 0;
};

}  // namespace gloam
