#pragma once
// Inbox: an open stream and its messages that wait for Python.

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "base/threads/bounded_queue.h"
#include "core.h"
#include "gloam/stream.h"

namespace gloam::python {

/// A message as Python gets it, made when it is asked for.
struct Waiting {
  int64_t step = 0;     ///< step from which the next message may begin
  double delivery = 0;  ///< [s]
  std::function<nb::object()> make;
};

class Inbox {
 public:
  /// `callback`: called for each message on the stream's thread, in place of keeping it; or none.
  Inbox(std::string name, int capacity, nb::object callback)
      : name_(std::move(name)),
        has_callback_(!callback.is_none()),
        callback_(std::move(callback)),
        waiting_({.items = static_cast<size_t>(capacity)}, Overflow::kDropOldest) {}

  void open(std::unique_ptr<Stream> stream, int64_t from) {
    stream_ = std::move(stream);
    next_from_ = from;
  }
  /// Raises a StuckError where the callback does not return within kCallbackTimeout: the stream is
  /// then left behind.
  void close();
  /// The same without raising. False: this must not be deleted.
  bool try_close();
  const std::string& name() const { return name_; }
  bool is_in_callback() const { return is_in_callback_; }
  /// Whether a callback has lasted longer than kCallbackTimeout.
  bool is_stuck() const;
  Stream& stream();
  bool is_open() const { return stream_ != nullptr; }

  // ---- threads of the stream ----
  void put(Waiting message);

  // ---- Python ----
  std::optional<Waiting> pop() { return waiting_.try_pop(); }
  /// Waits for a message while the simulation runs; empty: none within `timeout` [s of wall time].
  /// Raises: it has a callback, it ends or is closed, Ctrl-C.
  std::optional<Waiting> wait(std::optional<double> timeout);
  /// Raises a UsageError where messages go to a callback.
  void check_kept() const;
  /// Waits for the delivery of every message that is complete; raises what the callback has raised.
  void flush();
  void clear() { waiting_.take_all(); }
  int64_t lost() const { return static_cast<int64_t>(waiting_.dropped()); }
  /// For the collector of cycles.
  int traverse(visitproc visit, void* arg) const {
    Py_VISIT(callback_.ptr());
    return error_.traverse(visit, arg);
  }
  void clear_kept() {
    callback_.reset();
    error_.clear();
  }
  /// Raises what the callback has raised, once.
  void rethrow() { error_.rethrow(); }

  int64_t next_from() const { return next_from_; }
  void set_next_from(int64_t step) { next_from_ = step; }
  /// After time jumped to `step`.
  void restart(int64_t step) {
    next_from_ = step;
    ++restarts_;
  }
  int64_t restarts() const { return restarts_; }

 private:
  const std::string name_;  // "camera 'front'"
  const bool has_callback_;
  nb::object callback_;
  std::unique_ptr<Stream> stream_;
  BoundedQueue<Waiting> waiting_;
  FirstError error_;  // of the callback
  std::atomic<bool> is_in_callback_{false}, is_closing_{false};
  bool is_left_behind_ = false;
  std::atomic<std::thread::id> callback_thread_{};
  std::atomic<std::chrono::steady_clock::time_point> began_{};
  int64_t next_from_ = 0, restarts_ = 0;
};

}  // namespace gloam::python
