#include "runtime/recording/run_progress.h"

#include <algorithm>

namespace gloam {

double RunProgress::share() const {
  const auto steps = static_cast<double>(std::max<int64_t>(1, last_ - first_));
  const double simulated =
      std::clamp(static_cast<double>(simulator_.step_count() - first_) / steps, 0.0, 1.0);
  double slowest = simulated;
  for (const LiveCamera* const camera : cameras_) {
    if (camera->is_idle()) continue;  // it waits for the simulation
    const double length = steps * simulator_.timestep().value();
    const double pictures = length * camera->rate().value() + 1;
    slowest = std::min(slowest, camera->pictures_made() / pictures);
  }
  return slowest;
}

Progress RunProgress::of(Progress now) {
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  most_ = std::max(most_, share());
  now.done = most_;
  constexpr double kMinFractionForEstimate = 0.005;  // does not predict the rest
  now.left = most_ < kMinFractionForEstimate ? -1 : seconds * (1 - most_) / most_;
  return now;
}

}  // namespace gloam
