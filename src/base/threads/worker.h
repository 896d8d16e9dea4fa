#pragma once
// Worker: a thread that runs jobs in order, behind a bounded queue, so that other threads need not
// wait for them.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>

#include "base/threads/bounded_queue.h"

namespace gloam {

class Worker {
 public:
  using Job = std::function<void()>;

  /// `most`: jobs that may wait.
  Worker(size_t most, Overflow overflow);
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Jobs of one key other than 0 that are posted in a row are one: the last. A job that posts to
  /// its own worker does not wait for room. False: the job is not run, because too many wait or the
  /// worker has ended.
  bool post(Job job, int64_t key = 0);
  /// A job that is neither rejected nor dropped, such as the removal of a client that has gone.
  /// False: the worker has ended.
  bool post_always(Job job);
  /// No job waits.
  bool is_idle() const { return jobs_.is_empty(); }
  uint64_t dropped() const { return jobs_.dropped(); }

  /// Runs all waiting jobs and ends the thread. May be called twice.
  void close();
  /// Discards the waiting jobs and waits for the present one, which may look at stopping().
  void stop();
  bool stopping() const { return stopping_; }

 private:
  void run();

  const bool waits_;  // for room
  BoundedQueue<Job> jobs_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace gloam
