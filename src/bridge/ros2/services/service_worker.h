#pragma once
// ServiceWorker: the thread on which services run that take long, so that others are answered
// meanwhile, a pause among them.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace gloam::bridge {

class ServiceWorker {
 public:
  ServiceWorker();
  /// Throws away what waits; the job that runs should look at stopping().
  ~ServiceWorker();
  ServiceWorker(const ServiceWorker&) = delete;
  ServiceWorker& operator=(const ServiceWorker&) = delete;

  /// Jobs run one after the other. False: too many wait.
  bool add(std::function<void()> job);
  bool stopping() const { return stopping_; }

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<std::function<void()>> jobs_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace gloam::bridge
