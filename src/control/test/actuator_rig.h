#pragma once
// A flywheel on a hinge with actuator models, run through the Simulator.

#include <functional>
#include <memory>
#include <string>

#include "control/actuators/actuators.h"
#include "sim/loop/simulator.h"

namespace gloam {

/// A wheel without gravity.
struct Wheel {
  double inertia = 0.05;   ///< about the hinge, without the armature [kg m²]
  double armature = 0;     ///< [kg m²]
  double timestep = 1e-3;  ///< [s]
  double speed = 0;        ///< at the start [rad/s]
  std::string actuator = R"(<motor name="wheel" joint="wheel"/>)";
};

/// Its World: joint 0, actuator 0, body 1; robot "rig".
std::shared_ptr<CompiledWorld> wheel_world(const Wheel& wheel, const RobotOptions& options);

/// The actuator models of its robot, as RobotControllers.
std::vector<RobotController> robots_of(
    const std::shared_ptr<const CompiledWorld>& world,
    const ActuatorNetworkLoader& network = load_actuator_network);

class ActuatorRig {
 public:
  ActuatorRig(const Wheel& wheel, const RobotOptions& options,
              const ActuatorNetworkLoader& network = load_actuator_network);
  ActuatorRig(const Wheel& wheel, const ActuatorOptions& actuator)
      : ActuatorRig(wheel, RobotOptions{.actuator = {actuator}}) {}

  /// Constant from now on.
  void command(double control);
  /// Torque on the wheel from outside [N m].
  void load(double torque);
  void step(int64_t n = 1);

  double position() const { return sim_->latest()[Joint{0}].position(); }
  double speed() const { return sim_->latest()[Joint{0}].velocity(); }
  /// Force that the actuator applied in the last step, by a forward pass [N m].
  double force() const;
  ActuatorOutputs outputs() const { return sim_->latest().data().actuators.at(0); }
  Simulator& sim() { return *sim_; }
  const std::shared_ptr<CompiledWorld>& world() const { return world_; }

 private:
  std::shared_ptr<CompiledWorld> world_;
  std::unique_ptr<Simulator> sim_;
};

}  // namespace gloam
