#pragma once
// Steps at which any of several schedules is due, as SubscriptionOptions::due.

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "sim/loop/step_schedule.h"

namespace gloam {

/// The first step at or after the one given.
inline std::function<int64_t(int64_t step)> first_of(const std::vector<StepSchedule>& schedules) {
  std::vector<StepSchedule> unlike;  // many topics have the same
  for (const StepSchedule& schedule : schedules)
    if (std::ranges::count(unlike, schedule) == 0) unlike.push_back(schedule);
  return [unlike = std::move(unlike)](int64_t step) {
    int64_t next = std::numeric_limits<int64_t>::max();
    for (const StepSchedule& schedule : unlike)
      next = std::min(next, schedule.step_of(schedule.first_at_or_after(step)));
    return next;
  };
}

}  // namespace gloam
