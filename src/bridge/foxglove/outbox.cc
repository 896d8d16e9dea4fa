#include "bridge/foxglove/outbox.h"

#include <algorithm>
#include <utility>

namespace gloam::bridge::foxglove {
namespace {

constexpr size_t kFrameOverhead = 128;  // memory of a message beside its bytes, about

}  // namespace

void Outbox::send(Frame frame) { add(std::move(frame), true); }

void Outbox::offer(Frame frame) { add(std::move(frame), false); }

void Outbox::add(Frame frame, bool is_kept) {
  const std::lock_guard lock(mutex_);
  if (closed_ || overflowed_) return;
  const size_t bytes = frame.size() + kFrameOverhead;
  if (is_kept) {
    if (kept_bytes_ > limits_.kept_bytes) {
      overflowed_ = true;
      waiting_.clear();
      wake_();
      return;
    }
    kept_bytes_ += bytes;
  } else {
    make_room(bytes);
    data_bytes_ += bytes;
  }
  waiting_.push_back({std::move(frame), is_kept, Clock::now()});
  if (!std::exchange(taking_, true)) wake_();
}

void Outbox::make_room(size_t bytes) {
  auto oldest = waiting_.begin();
  while (data_bytes_ > 0 && data_bytes_ + bytes > limits_.data_bytes) {
    oldest = std::find_if(oldest, waiting_.end(), [](const Waiting& w) { return !w.is_kept; });
    data_bytes_ -= oldest->frame.size() + kFrameOverhead;
    oldest = waiting_.erase(oldest);
    ++dropped_;
  }
}

std::optional<Frame> Outbox::next() {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  while (!waiting_.empty()) {
    Waiting first = std::move(waiting_.front());
    waiting_.pop_front();
    (first.is_kept ? kept_bytes_ : data_bytes_) -= first.frame.size() + kFrameOverhead;
    if (first.is_kept || now - first.since <= limits_.data_age) return std::move(first.frame);
    ++dropped_;
  }
  taking_ = false;
  return {};
}

bool Outbox::overflowed() const {
  const std::lock_guard lock(mutex_);
  return overflowed_;
}

int64_t Outbox::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void Outbox::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  waiting_.clear();
}

}  // namespace gloam::bridge::foxglove
