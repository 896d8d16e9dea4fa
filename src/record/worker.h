#pragma once
// One thread that does jobs in order, with a bounded queue in front of it.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace gloam {

class Worker {
 public:
  /// `capacity` = most jobs that wait. `wait`: post() waits while the queue is full; otherwise the
  /// oldest waiting job is dropped and counted.
  Worker(size_t capacity, bool wait);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// May be called from any thread, not after close().
  void post(std::function<void()> job);
  /// Runs all queued jobs and ends the thread. May be called twice.
  void close();
  uint64_t dropped() const;

 private:
  void run();

  const size_t capacity_;
  const bool wait_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  uint64_t dropped_ = 0;
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace gloam
