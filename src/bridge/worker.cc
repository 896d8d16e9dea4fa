#include "bridge/worker.h"

#include <utility>

namespace gloam::bridge {

Worker::Worker(size_t most) : most_(most), thread_([this] { run(); }) {}

bool Worker::post(Job job, int64_t key) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return false;
    if (key != 0 && !waiting_.empty() && waiting_.back().key == key) {
      waiting_.back().job = std::move(job);
      return true;
    }
    if (waiting_.size() >= most_) return false;
    waiting_.push_back({std::move(job), key});
  }
  wake_.notify_one();
  return true;
}

void Worker::post_always(Job job) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(job), 0});
  }
  wake_.notify_one();
}

bool Worker::is_idle() {
  const std::lock_guard lock(mutex_);
  return waiting_.empty();
}

void Worker::stop() {
  std::deque<Waiting> thrown_away;  // outside of the lock: what jobs hold may post as it goes
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    thrown_away.swap(waiting_);
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Worker::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    const Job job = std::move(waiting_.front().job);
    waiting_.pop_front();
    lock.unlock();
    job();
    lock.lock();
  }
}

}  // namespace gloam::bridge
