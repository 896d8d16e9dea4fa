#pragma once
// Worker: a thread that does one job after the other, so that networks' threads need not wait.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace gloam::bridge {

class Worker {
 public:
  using Job = std::function<void()>;

  /// `most`: jobs that may wait.
  explicit Worker(size_t most);
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Jobs of one key other than 0 that come in a row are one: the last. False: too many wait, or it
  /// stops.
  bool post(Job job, int64_t key = 0);
  /// A job that must not be lost: where a client has gone.
  void post_always(Job job);
  /// No job waits.
  bool is_idle();
  /// Waits for the present job, which may look at stopping(); those that wait are thrown away.
  void stop();
  bool stopping() const { return stopping_; }

 private:
  struct Waiting {
    Job job;
    int64_t key = 0;
  };
  void run();

  const size_t most_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Waiting> waiting_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace gloam::bridge
