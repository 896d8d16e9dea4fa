#pragma once
// Controllers: code that drives a robot on the simulation's thread, between steps, at a declared
// rate. A type that is registered here is what `[robot.controller] type` may name.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/contact.h"
#include "gloam/result.h"
#include "gloam/world.h"

struct mjModel_;
struct mjData_;

namespace gloam {

/// Velocity that a walking or driving robot is to have.
struct VelocityTarget {
  double vx = 0, vy = 0, yaw_rate = 0;  ///< heading frame [m/s, m/s, rad/s]
};

/// Inputs of a controller at one call.
struct ControlInputs {
  const mjModel_* model;  ///< with the simulation's own options
  mjData_* data;          ///< data of the instant; contacts are the last step's
  /// Loads of soft ground in the last step, as contacts in `data`.
  std::span<const ContactLoad> loads;
  int64_t step = 0;     ///< number of the step that is taken next
  double period = 0;    ///< between calls [s]
  VelocityTarget goal;  ///< the robot's, from its scene or SetVelocityGoal
  /// Positions that SetJointGoal has given [rad, m], NaN = none, by MuJoCo's joint id, (njnt)
  std::span<const double> joint_goals = {};
};

/// Reads the state, writes controls. All calls come on the simulation's thread.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Begins anew: the simulation stands at its initial state, or a recompile brought the robot.
  virtual void reset(const mjModel_* model, const mjData_* data) = 0;
  /// Goes on from `before`, the same robot's controller in the World before a recompile: what it
  /// remembers of the robot counts, what it knows of the model is its own. Where that cannot be,
  /// it begins anew from where the simulation stands.
  virtual void take_over(const mjModel_* model, const mjData_* data, const Controller& before) {
    static_cast<void>(before);
    reset(model, data);
  }
  /// Writes data->ctrl of its own actuators only. Must not allocate, lock or throw.
  virtual void control(const ControlInputs& in) = 0;
  /// A copy that goes on exactly as this one would. Null: it cannot be copied; a checkpoint is then
  /// restored by stepping the run again.
  virtual std::unique_ptr<Controller> clone() const { return nullptr; }
};

/// The robot that a controller is made for, and its World.
struct ControllerRequest {
  World world;
  RobotOptions robot;  ///< name and robot.controller as the scene gives them
};
/// Null: the robot is not driven. Errors: with the options' place in the scene file.
using ControllerFactory =
    std::function<Result<std::unique_ptr<Controller>>(const ControllerRequest&)>;

/// Adds a type for scenes that are read from now on; any thread. Its own settings are
/// `[robot.controller.params]`. Error: a type of this name exists, or it is no identifier.
Status register_controller(std::string type, ControllerFactory factory);

/// The numbers of one key of `[robot.controller.params]`: one or an array; empty = not given.
/// Error: something else stands there.
Result<std::vector<double>> controller_param(const ControllerOptions& options,
                                             std::string_view key);

/// Types that there are, in the order in which they were registered; Gloam's own come first.
std::vector<std::string> controller_types();

}  // namespace gloam
