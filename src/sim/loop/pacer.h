#pragma once
// Keeps physics in step with the clock on the wall, never the other way round: lateness is counted
// and, when it grows large, forgiven; it does not change what is simulated.

#include <chrono>
#include <cstdint>

namespace gloam {

class RealTimePacer {
 public:
  /// `speed` > 0: simulated seconds per second.
  RealTimePacer(double timestep, double speed) : timestep_(timestep), speed_(speed) {}

  void set_speed(double speed);
  /// The clock starts anew at the next step: after a pause, a reset, a change of speed.
  void restart() { anchored_ = false; }

  /// True when step `step` may be taken now. Otherwise sleeps up to 5 ms and returns false, so that
  /// the caller can look after other things.
  bool ready(int64_t step);

  /// Steps that began more than 10 ms (or one timestep, if that is longer) late.
  int64_t missed() const { return missed_; }

 private:
  using Clock = std::chrono::steady_clock;

  double timestep_, speed_;
  bool anchored_ = false;
  Clock::time_point anchor_;
  int64_t anchor_step_ = 0;
  int64_t missed_ = 0;
};

}  // namespace gloam
