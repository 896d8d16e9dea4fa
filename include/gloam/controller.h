#pragma once
// Controllers: code that controls a robot on the simulation's thread, between steps, at a declared
// rate. Types that are registered here can be named in `[robot.controller] type`.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/contact.h"
#include "gloam/joints/joint_command.h"
#include "gloam/result.h"
#include "gloam/world.h"

struct mjModel_;
struct mjData_;

namespace gloam {

/// Target velocity of a walking, driving or flying robot.
struct VelocityTarget {
  double vx = 0, vy = 0, yaw_rate = 0;  ///< heading frame [m/s, m/s, rad/s]
  double vz = 0;                        ///< up, of a flying robot [m/s]
};

/// Inputs of a controller at one call.
struct ControlInputs {
  const mjModel_* model;  ///< with the simulation's own options
  mjData_* data;          ///< state at this instant; contacts are from the last step
  /// Loads of soft ground in the last step, like the contacts in `data`.
  std::span<const ContactLoad> loads;
  int64_t step = 0;     ///< number of the next step
  double period = 0;    ///< between calls [s]
  VelocityTarget goal;  ///< current goal of the robot, from the scene or SetVelocityGoal
  /// Targets from SetJointCommand, SetJointGoal and trajectories, indexed by MuJoCo's joint id,
  /// (njnt)
  std::span<const JointTarget> joint_targets = {};
  /// Pose X_WF of the robot's controlled frame, from SetPoseGoal; null = none.
  const Pose* pose_goal = nullptr;
};

/// How a simulation treats a controller.
struct ControllerTraits {
  bool every_step = false;  ///< called before each step, not at the rate in the scene
  /// Its controls are inputs of a log, like the numbers that a step hook writes: a log is verified
  /// and replayed without the controller and without the files that it reads.
  bool is_logged = false;
};

/// Reads the state and writes controls. All functions are called on the simulation's thread.
class Controller {
 public:
  virtual ~Controller() = default;
  virtual ControllerTraits traits() const { return {}; }
  /// Called once, before reset(): time between calls [s]. Error: the controller cannot run with it.
  virtual Status set_period(double period) {
    static_cast<void>(period);
    return {};
  }
  /// Starts from the beginning: the simulation is at its initial state, or a recompile added the
  /// robot.
  virtual void reset(const mjModel_* model, const mjData_* data) = 0;
  /// Continues from `before`, the same robot's controller before a recompile or a SetController,
  /// which may be of another type: takes over its memory of the robot, but not its data about the
  /// model. If that is impossible, starts from the beginning at the simulation's present state.
  virtual void take_over(const mjModel_* model, const mjData_* data, const Controller& before) {
    static_cast<void>(before);
    reset(model, data);
  }
  /// Writes data->ctrl of its own actuators only. Must not allocate, lock or throw.
  virtual void control(const ControlInputs& in) = 0;
  /// Returns a copy that continues exactly as this controller would. Null: it cannot be copied;
  /// checkpoints are then restored by stepping the run again.
  virtual std::unique_ptr<Controller> clone() const { return nullptr; }
  /// Returns the controller of the robot itself if this one also calls controllers of parts. Null:
  /// only parts have controllers.
  virtual const Controller* own() const { return this; }
};

/// The robot for which a controller is created, and its World.
struct ControllerRequest {
  World world;
  RobotOptions robot;  ///< name and robot.controller as in the scene
};
/// Null: the robot has no controller. Errors: with the location of the options in the scene file.
using ControllerFactory =
    std::function<Result<std::unique_ptr<Controller>>(const ControllerRequest&)>;

/// Adds a type for scenes that are read afterwards; any thread. Its settings are in
/// `[robot.controller.params]`. Error: a type of this name exists, or the name is not an
/// identifier.
Status register_controller(std::string type, ControllerFactory factory);

/// Returns the numbers of one key of `[robot.controller.params]`, a number or an array; empty = not
/// given. Error: the value is neither.
Result<std::vector<double>> controller_param(const ControllerOptions& options,
                                             std::string_view key);

/// Returns a controller's options as a scene file has them: "type = 'joint_position'\nkp = 80".
std::string to_toml(const ControllerOptions& options);
/// Reads them. Errors: as in a scene file, with the nearest names.
Result<ControllerOptions> parse_controller(std::string_view toml);

/// Returns the controller that the scene of a World gives a robot. Error: no such robot.
Result<ControllerOptions> scene_controller(const World& world, Robot robot);

/// All types in the order of registration; Gloam's own come first.
std::vector<std::string> controller_types();

}  // namespace gloam
