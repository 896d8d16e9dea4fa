#include "sim/loop/next_world.h"

#include <utility>

#include "base/memory.h"
#include "sim/loop/scene_schedule.h"

namespace gloam {

Result<NextWorld> make_next_world(const std::shared_ptr<const CompiledWorld>& world, uint64_t seed,
                                  std::optional<double> timestep,
                                  std::vector<RobotController> controllers,
                                  const DataMaker& make_data) {
  const Rational step_time = exact_rational(timestep.value_or(double{world->model->opt.timestep}));
  NextWorld next;
  GLOAM_TRY(next.scene_commands, scene_schedule(*world, step_time));
  GLOAM_TRY(next.stepper, or_no_memory("the simulation", [&] {
              return Stepper::create(world, seed, timestep, make_data);
            }));
  for (RobotController& controller : controllers) {
    if (controller.actuators != nullptr)
      GLOAM_TRY_STATUS(
          next.stepper->add_actuators(controller.robot, std::move(controller.actuators)));
    if (controller.controller == nullptr) continue;
    GLOAM_TRY(ControllerSlot slot, ControllerSlot::make(*world, std::move(controller), step_time));
    next.controllers.push_back(std::move(slot));
  }
  return next;
}

}  // namespace gloam
