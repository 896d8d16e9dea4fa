#include "record/worker.h"

#include "base/check.h"

namespace gloam {

Worker::Worker(size_t capacity, bool wait)
    : capacity_(capacity), wait_(wait), thread_([this] { run(); }) {
  GLOAM_CHECK(capacity > 0, "a queue holds at least one job");
}

Worker::~Worker() { close(); }

void Worker::post(std::function<void()> job) {
  std::unique_lock lock(mutex_);
  GLOAM_CHECK(!closed_, "a closed worker takes no jobs");
  if (wait_) {
    changed_.wait(lock, [this] { return jobs_.size() < capacity_; });
  } else if (jobs_.size() == capacity_) {
    jobs_.pop_front();
    ++dropped_;
  }
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void Worker::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

uint64_t Worker::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void Worker::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !jobs_.empty() || closed_; });
    if (jobs_.empty()) return;
    const std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    changed_.notify_all();
    lock.unlock();
    job();
    lock.lock();
  }
}

}  // namespace gloam
