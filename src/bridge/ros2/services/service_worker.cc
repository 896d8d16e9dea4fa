#include "bridge/ros2/services/service_worker.h"

namespace gloam::bridge {
namespace {

constexpr size_t kMostJobs = 64;

}  // namespace

ServiceWorker::ServiceWorker() : thread_([this] { run(); }) {}

ServiceWorker::~ServiceWorker() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    jobs_.clear();
  }
  came_.notify_all();
  thread_.join();
}

bool ServiceWorker::add(std::function<void()> job) {
  const std::lock_guard lock(mutex_);
  if (stopping_ || jobs_.size() >= kMostJobs) return false;
  jobs_.push_back(std::move(job));
  came_.notify_one();
  return true;
}

void ServiceWorker::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    came_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (stopping_) return;
    const std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    job();
    lock.lock();
  }
}

}  // namespace gloam::bridge
