#include "runtime/live/run_to_step.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

namespace gloam {

Result<int64_t> step_of_time(double time, Rational rate, const std::string& what) {
  constexpr double kMostSteps = 9007199254740992.0;  // 2^53: from there on doubles skip integers
  const double steps = time * rate.value();
  if (!(time >= 0 && steps <= kMostSteps)) {
    return Error{ErrorKind::kUsage, fmt::format("{} of {} s is not between 0 and {:.3g} s", what,
                                                time, kMostSteps / rate.value())};
  }
  return static_cast<int64_t>(std::llround(steps));
}

Status run_to_step(Simulator& simulator, int64_t step, const char* what, double start,
                   const ProgressCallback& progress, const std::function<Status()>& stop_early) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  constexpr std::chrono::milliseconds kStepPollPeriod{10};
  simulator.run_until(step);
  // At `step` it still waits for readers that have no room for its last Snapshots.
  while (!simulator.wait_for(kStepPollPeriod)) {
    const double done = static_cast<double>(simulator.step_count()) / static_cast<double>(step);
    const double seconds = start + std::chrono::duration<double>(Clock::now() - begin).count();
    Status stopped;
    if (progress && !progress({what, done, seconds})) {
      stopped = Error{ErrorKind::kInterrupted, "interrupted"};
    } else if (stop_early) {
      stopped = stop_early();
    }
    if (!stopped.ok()) {
      simulator.pause();
      return stopped;
    }
  }
  return simulator.status();
}

}  // namespace gloam
