#include "runtime/log/state_order.h"

#include <fmt/format.h>

#include <cmath>

namespace gloam {

Error StateOrder::damaged(const gloam_msgs::State& state, const std::string& why) const {
  return {ErrorKind::kInput,
          fmt::format("{}: the state at step {} of run {} is damaged: {}", log_, state.step,
                      state.run, why),
          {},
          "gloam export and other programs can still read the log's other topics"};
}

Status StateOrder::check(const gloam_msgs::State& state, double timestep, bool time_is_set) {
  if (state.state.empty()) return damaged(state, "it is empty");
  const double time = state.state[0];
  const bool begins = state.run != run_;
  if (state.run < run_ || state.run < 0)
    return damaged(state, fmt::format("it follows a state of run {}", run_));
  if (state.step < 0 || (!begins && state.step <= step_))
    return damaged(state, fmt::format("it follows a state at step {}", step_));
  const int64_t steps = begins ? state.step : state.step - step_;
  const int64_t most = begins ? kMostStepsBeforeLog : kMostStepsBetweenStates;
  if (steps > most)
    return damaged(state,
                   fmt::format("{} steps without a state precede it, more than {}", steps, most));
  // A keyframe may set the clock to a later time than 0.
  const double passed = begins ? time : time - time_;
  const double due = static_cast<double>(steps) * timestep;
  const double slack = 0.5 * timestep + 1e-6 * due;
  const bool fits =
      steps == 0 || (begins ? passed >= due - slack : std::abs(passed - due) <= slack);
  if (!time_is_set && !fits)
    return damaged(state, fmt::format("its {} steps of {:g} s do not match the elapsed {:g} s",
                                      steps, timestep, passed));
  run_ = state.run;
  step_ = state.step;
  time_ = time;
  return {};
}

}  // namespace gloam
