#pragma once
// NextWorld: everything that a SimLoop has of one World, made before the loop goes on in it.

#include <memory>
#include <optional>
#include <vector>

#include "sim/loop/controller_slot.h"
#include "sim/loop/stepper.h"

namespace gloam {

struct NextWorld {
  std::unique_ptr<Stepper> stepper;
  std::vector<Command> scene_commands;
  std::vector<ControllerSlot> controllers;
};

/// `timestep`: instead of the model's [s]. Takes as long as making a simulation does.
Result<NextWorld> make_next_world(const std::shared_ptr<const CompiledWorld>& world, uint64_t seed,
                                  std::optional<double> timestep,
                                  std::vector<RobotController> controllers,
                                  const DataMaker& make_data = {});

}  // namespace gloam
