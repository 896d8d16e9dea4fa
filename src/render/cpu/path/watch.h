#pragma once
// Lets a caller watch a render and end it: counts finished tiles from many threads. Holds the
// slices that the render is cut into.

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>

#include "render/slices.h"

namespace gloam {

class RenderWatch {
 public:
  RenderWatch(std::function<bool(double)> progress, int64_t tiles, RenderSlices& slices)
      : progress_(std::move(progress)), tiles_(tiles), slices_(slices) {}

  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  RenderSlices& slices() { return slices_; }
  /// One more tile is finished.
  void tile_done() { ask(1); }
  /// Whether the work in progress may continue.
  bool may_continue() {
    ask(0);
    return !stopped();
  }

 private:
  void ask(int64_t more) {
    const int64_t done = done_.fetch_add(more, std::memory_order_relaxed) + more;
    if (!progress_) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock() || stopped()) return;
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    if (!progress_(static_cast<double>(done) / static_cast<double>(tiles_))) stopped_ = true;
  }

  const std::function<bool(double)> progress_;
  const int64_t tiles_;
  RenderSlices& slices_;
  std::atomic<int64_t> done_{0};
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
};

}  // namespace gloam
