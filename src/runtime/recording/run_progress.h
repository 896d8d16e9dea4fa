#pragma once
// RunProgress: how much of a recorded run is done, and how long the rest takes.

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/streams/live_camera.h"

namespace gloam {

/// The simulation runs ahead of its cameras by the pictures that wait to be made, and those take
/// most of the time. So a run has got as far as its slowest camera has.
class RunProgress {
 public:
  using Cameras = std::vector<LiveCamera*>;
  /// From step `first` to step `last`; the cameras outlive it.
  RunProgress(const Simulator& simulator, int64_t first, int64_t last, const Cameras& cameras)
      : simulator_(simulator), first_(first), last_(last), cameras_(cameras) {}

  /// Adds the share that is done, and the time that the rest takes, to `now`.
  Progress of(Progress now);

 private:
  using Clock = std::chrono::steady_clock;
  double share() const;

  const Simulator& simulator_;
  const int64_t first_, last_;
  const Cameras& cameras_;
  const Clock::time_point begin_ = Clock::now();
  double most_ = 0;  // progress never goes back
};

}  // namespace gloam
