#pragma once
// The controllers of a simulation: whose they are and when they are called.

#include <memory>

#include "gloam/controller.h"
#include "sim/loop/step_schedule.h"
#include "world/world.h"

namespace gloam {

/// The controller of one robot, by its number in the World, called `rate` times a second [Hz].
struct RobotController {
  int robot = 0;
  std::unique_ptr<Controller> controller;
  Rational rate;
};

/// A controller and when it is called.
struct ControllerSlot {
  /// Errors: a rate of which the step rate is no multiple.
  static Result<ControllerSlot> make(const CompiledWorld& world, RobotController controller,
                                     Rational timestep);
  /// Its first call is at or after `step`.
  void begin(int64_t step);

  int robot = 0;
  std::unique_ptr<Controller> controller;
  StepSchedule schedule;
  double period = 0;  // [s]
  int64_t k = 0, due = 0;
};

}  // namespace gloam
