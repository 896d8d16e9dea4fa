#include "sim/loop/controller_slot.h"

#include <fmt/format.h>

#include <utility>

namespace gloam {

Result<ControllerSlot> ControllerSlot::make(const CompiledWorld& world, RobotController controller,
                                            Rational timestep) {
  if (controller.robot < 0 || controller.robot >= static_cast<int>(world.robots.size())) {
    return Error{ErrorKind::kUsage, fmt::format("there is no robot number {}", controller.robot)};
  }
  const Controller* const made = controller.controller.get();
  const ControllerTraits traits = made != nullptr ? made->traits() : ControllerTraits{};
  const bool at_each_step = made == nullptr || traits.every_step;
  const Rational rate = at_each_step ? Rational{timestep.den, timestep.num} : controller.rate;
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
  const double period = static_cast<double>(rate.den) / static_cast<double>(rate.num);
  if (Status status = made != nullptr ? controller.controller->set_period(period) : Status();
      !status) {
    Error error = std::move(status).error();
    error.loc = loc;
    return error;
  }
  return ControllerSlot{controller.robot, std::move(controller.controller), *schedule, period,
                        traits.is_logged};
}

Result<std::vector<RobotController>> make_controllers(
    const std::shared_ptr<const CompiledWorld>& world, const RobotMakers& make) {
  std::vector<RobotController> controllers;
  for (size_t i = 0; i < world->robots.size(); ++i) {
    const RobotInstance& robot = world->robots[i];
    const ControllerOptions& options = robot.options.controller;
    RobotController made{static_cast<int>(i), nullptr, options.rate};
    if (options.type != "none" || !robot.options.parts.empty()) {
      GLOAM_TRY(made.controller, make.controller(world, made.robot, options));
    }
    if (make.actuators) {
      GLOAM_TRY(made.actuators, make.actuators(*world, robot));
    }
    if (made.controller != nullptr || made.actuators != nullptr)
      controllers.push_back(std::move(made));
  }
  return controllers;
}

void ControllerSlot::begin(int64_t step) {
  k = schedule.first_at_or_after(step);
  due = schedule.step_of(k);
}

std::optional<ControllerSlot> ControllerSlot::clone() const {
  ControllerSlot copy{robot, nullptr, schedule, period, is_logged, k, due, options};
  if (controller == nullptr) return copy;
  copy.controller = controller->clone();
  if (copy.controller == nullptr) return std::nullopt;
  return copy;
}

void RobotControl::switch_to(ControllerSlot* next) {
  if (!is_switched()) std::swap(now, parked);
  std::swap(now, *next);
}

void RobotControl::restore_scene() {
  if (is_switched()) std::swap(now, parked);
}

std::optional<RobotControl> RobotControl::clone() const {
  std::optional<ControllerSlot> running = now.clone(), kept = parked.clone();
  if (!running || !kept) return std::nullopt;
  return RobotControl{std::move(*running), std::move(*kept)};
}

}  // namespace gloam
