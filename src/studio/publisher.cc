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
  const std::lock_guard lock(mutex_);
  newest_ = {std::move(frame), newest_.sequence + 1};
  waiting_.push(newest_);
}

std::shared_ptr<const CameraFrame> Publisher::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_.frame;
}

uint64_t Publisher::sequence() const {
  const std::lock_guard lock(mutex_);
  return newest_.sequence;
}

void Publisher::forget() {
  const std::lock_guard lock(mutex_);
  newest_.frame.reset();
  waiting_.take_all();
}

void Publisher::stop() {
  waiting_.close();
  waiting_.take_all();
  if (thread_.joinable()) thread_.join();
}

void Publisher::run() {
  auto next_beat = Clock::now();
  while (!waiting_.has_ended()) {
    if (const auto offer = waiting_.pop_until(next_beat))
      outputs_.picture(offer->frame, offer->sequence);
    if (const auto now = Clock::now(); now >= next_beat) {
      next_beat = now + std::chrono::milliseconds(100);
      outputs_.beat();
    }
  }
}

}  // namespace gloam::studio
