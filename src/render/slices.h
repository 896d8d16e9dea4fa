#pragma once
// RenderSlices: the work of one picture or scan, cut between its tasks where another sensor should
// have the renderer first.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "render/turns.h"

namespace gloam {

class RenderSlices {
 public:
  /// `turns`: null = nobody else uses the renderer. `again` updates the renderer to this picture's
  /// instant after another sensor has used it, and all that refers to its scene.
  RenderSlices(RenderTurns* turns, std::function<void()> again)
      : turns_(turns), again_(std::move(again)) {}

  /// To be called between two stages: lets others go first.
  void pause() {
    if (turns_ == nullptr || !turns_->is_wanted() || !turns_->pass()) return;
    const auto start = std::chrono::steady_clock::now();
    again_();
    turns_->count_update(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

  /// Calls f(i) for every i in [0, n) on all threads, as parallel_for does. Where others go first,
  /// `again` is called between two tasks; what f refers to must be read anew by each task.
  template <class F>
  void run(const char* name, int64_t n, const F& f) {
    pause();
    if (turns_ == nullptr) return parallel_for(name, n, f);
    std::vector<uint8_t> done(static_cast<size_t>(n));
    std::atomic<bool> is_cut{true};
    while (is_cut) {
      is_cut = false;
      parallel_for(name, n, [&](int64_t i) {
        if (done[static_cast<size_t>(i)] != 0) return;
        if (turns_->is_wanted()) {
          is_cut.store(true, std::memory_order_relaxed);
          return;
        }
        f(i);
        done[static_cast<size_t>(i)] = 1;
      });
      if (is_cut) pause();
    }
  }

 private:
  RenderTurns* const turns_;
  const std::function<void()> again_;
};

}  // namespace gloam
