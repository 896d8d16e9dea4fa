#pragma once
// The controllers of a simulation: whose they are and when they are called.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "gloam/controller.h"
#include "sim/loop/actuator_layer.h"
#include "sim/loop/step_schedule.h"
#include "world/world.h"

namespace gloam {

/// Makes the controller of a robot, by its number in the World, with these options; null for
/// "none".
using ControllerMaker = std::function<Result<std::unique_ptr<Controller>>(
    const std::shared_ptr<const CompiledWorld>&, int robot, const ControllerOptions&)>;
/// Makes the models of a robot's actuators; null if it has none.
using ActuatorMaker = std::function<Result<std::unique_ptr<ActuatorLayer>>(const CompiledWorld&,
                                                                           const RobotInstance&)>;
struct RobotMakers {
  ControllerMaker controller;
  ActuatorMaker actuators = {};  ///< empty = no robot has models of its actuators
};

/// The controller of one robot, by its number in the World, called `rate` times a second [Hz], and
/// the models of its actuators. Either may be null.
struct RobotController {
  int robot = 0;
  std::unique_ptr<Controller> controller;
  Rational rate;
  std::unique_ptr<ActuatorLayer> actuators = {};
};

/// The controllers and actuator models that the scene gives its robots.
Result<std::vector<RobotController>> make_controllers(
    const std::shared_ptr<const CompiledWorld>& world, const RobotMakers& make);

/// A controller and when it is called.
struct ControllerSlot {
  /// Errors: a rate of which the step rate is no multiple.
  static Result<ControllerSlot> make(const CompiledWorld& world, RobotController controller,
                                     Rational timestep);
  /// Its first call is at or after `step`.
  void begin(int64_t step);
  /// A copy; nothing where the controller cannot be copied.
  std::optional<ControllerSlot> clone() const;

  int robot = 0;
  std::unique_ptr<Controller> controller = nullptr;  ///< null = none
  StepSchedule schedule = {};
  double period = 0;       // [s]
  bool is_logged = false;  // ControllerTraits
  int64_t k = 0, due = 0;
  /// Options from SetController; null = the scene's
  std::shared_ptr<const ControllerOptions> options = nullptr;
};

/// The controller of a robot, and the scene's while a Command has replaced it.
struct RobotControl {
  ControllerSlot now, parked;

  bool is_switched() const { return now.options != nullptr; }
  /// `next` gets what is no longer needed, whose memory is then released on another thread.
  void switch_to(ControllerSlot* next);
  /// Back to the scene's.
  void restore_scene();
  std::optional<RobotControl> clone() const;
};

}  // namespace gloam
