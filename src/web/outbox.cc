#include "web/outbox.h"

#include <utility>

namespace gloam::web {
namespace {

constexpr size_t kFrameOverhead = 128;  // memory of a message beside its bytes, about

}  // namespace

void Outbox::send(Frame frame) { add(std::move(frame), true); }

void Outbox::offer(Frame frame) { add(std::move(frame), false); }

void Outbox::add(Frame frame, bool is_kept) {
  const std::lock_guard lock(mutex_);
  if (closed_ || overflowed_) return;
  const size_t bytes = frame.size() + kFrameOverhead;
  if (is_kept && kept_bytes_ > options_.kept_bytes) {
    overflowed_ = true;
    waiting_.take_all();
    return wake_();
  }
  if (is_kept) kept_bytes_ += bytes;
  waiting_.push({std::move(frame), is_kept, Clock::now()}, {.bytes = bytes, .is_kept = is_kept});
  wake_taker();
}

void Outbox::replace(size_t slot, Frame frame) {
  const std::lock_guard lock(mutex_);
  if (closed_ || overflowed_) return;
  slots_.at(slot).newest = std::move(frame);
  wake_taker();
}

bool Outbox::append(size_t slot, Frame frame) {
  const std::lock_guard lock(mutex_);
  if (closed_ || overflowed_) return false;
  std::optional<Frame>& newest = slots_.at(slot).newest;
  if (newest.has_value()) {
    newest.reset();
    return false;
  }
  newest = std::move(frame);
  wake_taker();
  return true;
}

void Outbox::acknowledge(size_t slot) {
  const std::lock_guard lock(mutex_);
  if (closed_ || slots_.at(slot).unacknowledged == 0) return;
  --slots_[slot].unacknowledged;
  wake_taker();
}

void Outbox::wake_taker() {
  if (!std::exchange(taking_, true)) wake_();
}

std::optional<Frame> Outbox::next() {
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  while (auto first = waiting_.try_pop()) {
    if (first->is_kept) kept_bytes_ -= first->frame.size() + kFrameOverhead;
    if (first->is_kept || now - first->since <= options_.data_age) return std::move(first->frame);
    ++outdated_;
  }
  auto frame = next_of_slots();
  taking_ = frame.has_value();
  return frame;
}

std::optional<Frame> Outbox::next_of_slots() {
  for (size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    const int most = options_.slots[i];
    if (!slot.newest || (most > 0 && slot.unacknowledged == most)) continue;
    if (most > 0) ++slot.unacknowledged;
    return std::exchange(slot.newest, std::nullopt);
  }
  return {};
}

bool Outbox::overflowed() const {
  const std::lock_guard lock(mutex_);
  return overflowed_;
}

int64_t Outbox::dropped() const {
  const std::lock_guard lock(mutex_);
  return outdated_ + static_cast<int64_t>(waiting_.dropped());
}

void Outbox::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  waiting_.take_all();
  slots_.assign(slots_.size(), {});
}

}  // namespace gloam::web
