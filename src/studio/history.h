#pragma once
// The recent past of a simulation, to which its user steps back. Used by one thread at a time.

#include <chrono>
#include <deque>

#include "gloam/checkpoint.h"
#include "gloam/simulation.h"

namespace gloam::studio {

class History {
 public:
  explicit History(Simulation& simulation) : simulation_(simulation) {}

  /// Saves the present instant if it is time to; call it often.
  void keep();
  /// Earliest instant that it can return to [s]; the present without one.
  double start() const;
  /// Goes to an earlier step and pauses there: continues from the instant saved before it with the
  /// Commands of that time. Errors: no instant was saved before it; as for Simulation::restore().
  Status return_to(int64_t step);
  /// Whether return_to() has to repeat the run from its beginning.
  bool repeats_run() const { return !saved_.empty() && !saved_.back().is_copied(); }

 private:
  using Clock = std::chrono::steady_clock;

  Simulation& simulation_;
  std::deque<Checkpoint> saved_;  // oldest first
  uint64_t world_ = 0;            // serial of its World
  double last_time_ = 0;          // seen by keep() [s]
  Clock::time_point saved_at_;
};

}  // namespace gloam::studio
