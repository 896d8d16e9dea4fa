#include "studio/publisher.h"

#include <chrono>

namespace gloam::studio {

using Clock = std::chrono::steady_clock;

Publisher::Publisher(Outputs outputs) : outputs_(std::move(outputs)) {}

Publisher::~Publisher() { stop(); }

void Publisher::start() {
  thread_ = std::thread([this] { run(); });
}

void Publisher::offer(std::shared_ptr<const CameraFrame> frame) {
  {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(frame);
    ++sequence_;
  }
  wake_.notify_one();
}

std::shared_ptr<const CameraFrame> Publisher::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

uint64_t Publisher::sequence() const {
  const std::lock_guard lock(mutex_);
  return sequence_;
}

void Publisher::forget() {
  const std::lock_guard lock(mutex_);
  newest_.reset();
  encoded_ = sequence_;
}

void Publisher::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Publisher::run() {
  auto next_beat = Clock::now();
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    wake_.wait_until(lock, next_beat, [this] { return stopping_ || encoded_ != sequence_; });
    if (stopping_) return;
    if (encoded_ != sequence_) {
      const auto frame = newest_;
      const uint64_t sequence = encoded_ = sequence_;
      lock.unlock();
      outputs_.picture(*frame, sequence);
      lock.lock();
    }
    if (const auto now = Clock::now(); now >= next_beat) {
      next_beat = now + std::chrono::milliseconds(100);
      lock.unlock();
      outputs_.beat();
      lock.lock();
    }
  }
}

}  // namespace gloam::studio
