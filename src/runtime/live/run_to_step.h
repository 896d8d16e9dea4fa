#pragma once
// Running a simulation to a given time while its user watches and may stop it.

#include "gloam/result.h"
#include "gloam/run.h"
#include "sim/loop/simulator.h"

namespace gloam {

/// The step nearest to `time` [s] at `rate` steps per second. `what` names the time in the error.
/// Errors (usage): negative, not a number, beyond what steps can count.
Result<int64_t> step_of_time(double time, Rational rate, const std::string& what);

/// Steps to `step`, then waits there, in the background of this thread, which reports progress from
/// 0 to 1 and asks `stop_early` (may be empty) for a reason to end. `start` = wall time already
/// spent [s]. Errors: physics failed, interrupted by the user, what stop_early says.
Status run_to_step(Simulator& simulator, int64_t step, const char* what, double start,
                   const ProgressCallback& progress, const std::function<Status()>& stop_early);

}  // namespace gloam
