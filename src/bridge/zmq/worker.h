#pragma once
// Worker: slow operations, one after the other on a thread of their own.

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace gloam::bridge::zeromq {

class Worker {
 public:
  using Job = std::function<void()>;

  Worker();
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// False: too many wait already.
  bool post(Job job);
  /// Waits for the job that runs; those that wait are thrown away.
  void stop();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace gloam::bridge::zeromq
