#pragma once
// StateOrder: whether the states of a log follow each other as those of a run do.

#include <cstdint>
#include <string>
#include <utility>

#include "gloam/result.h"
#include "ros/messages/gloam_msgs.h"

namespace gloam {

/// Steps that may lie between two states of a log, and before the first state of a run: a
/// simulation may have run for days before its log began. So the work of stepping a log again is
/// bounded by the number of states in the file.
inline constexpr int64_t kMostStepsBetweenStates = 10'000'000;
inline constexpr int64_t kMostStepsBeforeLog = 1'000'000'000;

class StateOrder {
 public:
  /// `log`: its name, for errors.
  explicit StateOrder(std::string log) : log_(std::move(log)) {}

  /// Checks the next state of the log: runs and steps only grow, by as many steps as the time that
  /// passes. `timestep`: of its World [s]. `time_is_set`: a program has written the time of this
  /// run, which then tells nothing of steps.
  Status check(const gloam_msgs::State& state, double timestep, bool time_is_set);

 private:
  Error damaged(const gloam_msgs::State& state, const std::string& why) const;

  std::string log_;
  int64_t run_ = -1, step_ = 0;  // of the last state
  double time_ = 0;              // its time [s]
};

}  // namespace gloam
