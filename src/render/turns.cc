#include "render/turns.h"

#include <algorithm>

#include "base/check.h"

namespace gloam {
namespace {

constexpr double kSlicePerUpdate = 4;

}  // namespace

void RenderTurns::grant(RenderUse& use) {
  holder_ = &use;
  since_ = Clock::now();
  floor_ = std::max(floor_, use.used);
}

// Adds the time since the last settlement to the holder's account.
void RenderTurns::settle() {
  const auto now = Clock::now();
  holder_->used += std::chrono::duration<double>(now - since_).count();
  since_ = now;
}

void RenderTurns::find_least() {
  double least = kNobody;
  for (const Waiting* one : waiting_) least = std::min(least, one->use->used);
  least_waiting_.store(least, std::memory_order_relaxed);
}

// Hands the turn to the one that has used least, the first to come among equals.
void RenderTurns::grant_next() {
  holder_ = nullptr;
  if (waiting_.empty()) return;
  const auto next =
      std::ranges::min_element(waiting_, {}, [](const Waiting* one) { return one->use->used; });
  Waiting* const one = *next;
  waiting_.erase(next);
  find_least();
  grant(*one->use);
  one->has_turn = true;
  one->granted.notify_one();
}

void RenderTurns::wait_for_turn(std::unique_lock<std::mutex>& lock, RenderUse& use) {
  Waiting one{&use, {}};
  waiting_.push_back(&one);
  find_least();
  const auto asked = Clock::now();
  if (holder_ == nullptr) grant_next();
  one.granted.wait(lock, [&one] { return one.has_turn; });
  use.waited += std::chrono::duration<double>(Clock::now() - asked).count();
}

void RenderTurns::take(RenderUse& use) {
  std::unique_lock lock(mutex_);
  use.used = std::max(use.used, floor_ - slice_);
  if (holder_ == nullptr) return grant(use);
  wait_for_turn(lock, use);
}

void RenderTurns::give() {
  const std::lock_guard lock(mutex_);
  GLOAM_CHECK(holder_ != nullptr, "a turn must be released exactly once");
  settle();
  grant_next();
}

bool RenderTurns::is_wanted() const {
  const double least = least_waiting_.load(std::memory_order_relaxed);
  if (least == kNobody) return false;
  const double turn = std::chrono::duration<double>(Clock::now() - since_).count();
  return holder_->used + turn > least + slice_.load(std::memory_order_relaxed);
}

bool RenderTurns::pass() {
  std::unique_lock lock(mutex_);
  settle();
  if (waiting_.empty()) return false;
  RenderUse& mine = *holder_;
  const auto least = least_waiting_.load(std::memory_order_relaxed);
  if (mine.used <= least) return false;
  holder_ = nullptr;
  wait_for_turn(lock, mine);
  return true;
}

void RenderTurns::count_update(double seconds) {
  slice_.store(std::max(kShortestSlice, kSlicePerUpdate * seconds), std::memory_order_relaxed);
}

}  // namespace gloam
