#include "control/controllers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "base/text.h"
#include "control/actuators/actuators.h"
#include "control/drive/diff_drive.h"
#include "control/flight/quadrotor.h"
#include "control/gripper.h"
#include "control/inverse_kinematics.h"
#include "control/joint_controller.h"
#include "control/operational_space.h"
#include "control/parted_controller.h"
#include "control/task_frame.h"
#include "control/torque.h"
#include "control/trot.h"
#include "policy/policy_controller.h"
#include "scene/options/controller_types.h"

namespace gloam {
namespace {

using OwnFactory = Result<std::unique_ptr<Controller>> (*)(const CompiledWorld&,
                                                           const RobotInstance&);

using GoalsOf = Result<RobotGoals> (*)(const CompiledWorld&, const RobotInstance&);

Result<RobotGoals> no_goals(const CompiledWorld&, const RobotInstance&) { return RobotGoals(); }

Result<std::unique_ptr<Controller>> make_none(const CompiledWorld&, const RobotInstance&) {
  return std::unique_ptr<Controller>();
}

// Gloam's own; names and options are in scene/options/controller_types.cc.
struct OwnController {
  std::string_view name;
  OwnFactory make;
  GoalsOf goals = no_goals;
  bool is_logged = false;  // ControllerTraits
};
constexpr OwnController kControllers[] = {
    {"none", make_none},
    {"torque", make_torque_controller},
    {"joint_position", make_joint_position_controller},
    {"trot", make_trot_controller, trot_goals},
    {"quadrotor", make_quadrotor_controller, quadrotor_goals},
    {"diff_drive", make_diff_drive_controller, diff_drive_goals},
    {"gripper", make_gripper_controller, gripper_goals},
    {"joint_velocity", make_joint_velocity_controller},
    {"joint_effort", make_joint_effort_controller},
    {"ik", make_inverse_kinematics_controller, task_frame_goals},
    {"osc", make_operational_space_controller, task_frame_goals},
    {"policy", make_policy_controller, policy_goals, true},
};

struct RegisteredControllers {
  std::mutex mutex;
  std::map<std::string, ControllerFactory> factories;
};

RegisteredControllers& registered() {
  static RegisteredControllers instance;
  return instance;
}

ControllerFactory find_registered(const std::string& type) {
  RegisteredControllers& all = registered();
  const std::lock_guard lock(all.mutex);
  const auto found = all.factories.find(type);
  return found != all.factories.end() ? found->second : ControllerFactory();
}

}  // namespace

Status register_controller(std::string type, ControllerFactory factory) {
  if (!factory) return Error{ErrorKind::kUsage, "a controller needs a factory"};
  GLOAM_TRY_STATUS(add_controller_type(type));
  RegisteredControllers& all = registered();
  const std::lock_guard lock(all.mutex);
  all.factories.emplace(std::move(type), std::move(factory));
  return {};
}

std::vector<std::string> controller_types() {
  const std::vector<std::string_view> names = controller_type_names();
  return {names.begin(), names.end()};
}

Result<ControllerOptions> scene_controller(const World& world, Robot robot) {
  const std::vector<RobotInstance>& robots = world.compiled()->robots;
  if (robot.id >= 0 && robot.id < std::ssize(robots))
    return robots[static_cast<size_t>(robot.id)].options.controller;
  return Error{ErrorKind::kUsage, fmt::format("there is no robot number {}", robot.id)};
}

bool has_logged_controls(const ControllerOptions& options) {
  return std::ranges::any_of(kControllers, [&](const OwnController& own) {
    return own.is_logged && own.name == options.type;
  });
}

Result<RobotGoals> controller_goals(const CompiledWorld& world, const RobotInstance& robot) {
  const std::string& type = robot.options.controller.type;
  for (const OwnController& own : kControllers)
    if (type == own.name) return own.goals(world, robot);
  RobotGoals goals;
  if (has_controller_option(type, "goals")) goals.velocity.emplace();
  return goals;
}

Result<std::unique_ptr<Controller>> make_controller(
    const std::shared_ptr<const CompiledWorld>& world, const RobotInstance& robot) {
  const ControllerOptions& options = robot.options.controller;
  for (const OwnController& own : kControllers)
    if (options.type == own.name) return own.make(*world, robot);
  if (const ControllerFactory make = find_registered(options.type))
    return make({World(world), robot.options});
  return Error{ErrorKind::kInput, fmt::format("unknown controller '{}'", options.type), options.loc,
               suggest_name(options.type, controller_types())};
}

Result<std::unique_ptr<Controller>> make_robot_controller(
    const std::shared_ptr<const CompiledWorld>& world, int robot,
    const ControllerOptions& options) {
  RobotInstance changed = world->robots[static_cast<size_t>(robot)];
  changed.options.controller = options;
  return changed.options.parts.empty() ? make_controller(world, changed)
                                       : make_parted_controller(world, changed);
}

namespace {

Result<std::unique_ptr<ActuatorLayer>> make_own_actuators(const CompiledWorld& world,
                                                          const RobotInstance& robot) {
  return make_actuators(world, robot);
}

}  // namespace

RobotMakers robot_makers() { return {make_robot_controller, make_own_actuators}; }

RobotMakers replay_makers() {
  const ControllerMaker make =
      [](const std::shared_ptr<const CompiledWorld>& world, int robot,
         const ControllerOptions& options) -> Result<std::unique_ptr<Controller>> {
    // The controls of all parts are logged if those of one are (PartedController::traits).
    bool is_logged = has_logged_controls(options);
    for (const RobotPart& part : world->robots[static_cast<size_t>(robot)].options.parts)
      is_logged = is_logged || has_logged_controls(part.controller);
    if (is_logged) return std::unique_ptr<Controller>();
    return make_robot_controller(world, robot, options);
  };
  return {make, make_own_actuators};
}

}  // namespace gloam
