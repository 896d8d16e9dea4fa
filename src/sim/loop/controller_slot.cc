#include "sim/loop/controller_slot.h"

#include <fmt/format.h>

namespace gloam {

Result<ControllerSlot> ControllerSlot::make(const CompiledWorld& world, RobotController controller,
                                            Rational timestep) {
  if (controller.robot < 0 || controller.robot >= static_cast<int>(world.robots.size())) {
    return Error{ErrorKind::kUsage, fmt::format("there is no robot number {}", controller.robot)};
  }
  const Rational rate = controller.rate;
  const SourceLoc& loc = world.robots[static_cast<size_t>(controller.robot)].options.controller.loc;
  Result<StepSchedule> schedule = StepSchedule::make(rate, {0, 1}, timestep);
  if (!schedule) {
    Error error = schedule.error();
    error.loc = loc;
    return error;
  }
  // Calls must be evenly spaced: 1 / rate is a whole number of timesteps.
  const __int128 steps = static_cast<__int128>(rate.den) * timestep.den;
  if (steps % (static_cast<__int128>(rate.num) * timestep.num) != 0) {
    return Error{ErrorKind::kInput,
                 fmt::format("the controller's rate of {:g} Hz does not divide the simulation's "
                             "step rate of {:g} Hz",
                             rate.value(), 1 / timestep.value()),
                 loc, "choose a rate that divides the step rate"};
  }
  return ControllerSlot{controller.robot, std::move(controller.controller), *schedule,
                        static_cast<double>(rate.den) / static_cast<double>(rate.num)};
}

void ControllerSlot::begin(int64_t step) {
  k = schedule.first_at_or_after(step);
  due = schedule.step_of(k);
}

}  // namespace gloam
