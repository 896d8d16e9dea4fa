#pragma once
// RunEnds: where the runs of a simulation lie in a time that goes on over resets.

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <vector>

namespace gloam {

/// May be called on all threads.
class RunEnds {
 public:
  /// The present run ends at `time` [s], and the next one begins.
  void end_run(double time) {
    const std::lock_guard lock(mutex_);
    starts_.push_back(starts_.back() + std::max(time, 0.0));
  }
  /// Sum of the times [s] of the runs that ended before it; negative = the present one.
  double start_of(int64_t run) const {
    const std::lock_guard lock(mutex_);
    return run < 0 ? starts_.back()
                   : starts_[std::min(static_cast<size_t>(run), starts_.size() - 1)];
  }

 private:
  mutable std::mutex mutex_;
  std::vector<double> starts_ = {0};  // by run [s]
};

}  // namespace gloam
